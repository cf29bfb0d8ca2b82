"""All mistakes of a gait file that fits its format, not only the first one."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from windup.control.pose_graph.gait_checks import table_mistakes
from windup.control.pose_graph.gait_file import GaitFile
from windup.control.pose_graph.gait_reader import GaitReader, Mirroring
from windup.hal.contacts import ContactSensors
from windup.hal.errors import ConfigError
from windup.hal.joints import Joints


def gait_mistakes(
    path: Path, file: GaitFile, joints: Joints, contacts: ContactSensors, mirror: Mirroring
) -> list[str]:
    """Return the mistakes of a gait for a robot, one line each; see `load_gait`."""
    found = [f"{path}: {key}: {mistake}" for key, mistake in table_mistakes(file, joints)]
    reader = GaitReader(path, file, joints, contacts, mirror)
    for part in _parts(reader):
        found += _said(part)
    for state in file.state:
        if not _said(partial(reader.limit_errors, state)):
            found += map(str, reader.limit_errors(state))
    if not found:
        found += _said(lambda: reader.perturbations(reader.graph()))
    named = (line if line.startswith(f"{path}: ") else f"{path}: {line}" for line in found)
    return list(dict.fromkeys(named))


def _parts(reader: GaitReader) -> Iterator[Callable[[], object]]:
    """Yield a conversion for each part of the file; it raises ConfigError for a mistake."""
    yield reader.check_names
    for index, state in enumerate(reader.file.state):
        yield partial(reader.limit_errors, state)
        yield partial(reader.hold_of, state)
        yield partial(reader.sensors_of, state)
        yield partial(reader.next_of, index, state)
        yield partial(reader.foot_of, state)
    for item in reader.file.perturbation:
        yield partial(reader.parts_of, item)


def _said(part: Callable[[], object]) -> list[str]:
    """Return the message of the error that a conversion raises, if any."""
    try:
        part()
    except ConfigError as error:
        return [str(error)]
    return []
