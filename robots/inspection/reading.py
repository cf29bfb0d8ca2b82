"""Reading of a robot folder with mistakes: all of them at once, and the parts that are valid."""

from dataclasses import dataclass
from functools import partial
from math import isnan
from pathlib import Path
from typing import Any, TypeVar

import msgspec
import mujoco

from windup.hal.config import non_finite_numbers, read_toml
from windup.hal.errors import ConfigError
from windup.hal.key_mistakes import key_mistakes, without_unknown
from windup.robots import mjcf
from windup.robots.checks import Checks
from windup.robots.completion import complete_for
from windup.robots.description import (
    RobotDescription,
    describe,
    with_drive_defaults,
    with_mjcf_limits,
)
from windup.robots.folders import FILE
from windup.robots.mjcf_numbers import wrong_numbers
from windup.robots.records import RobotFile

T = TypeVar("T")
MODEL = "model.xml"


@dataclass(frozen=True)
class FolderContents:
    """The valid parts of a robot folder, and its mistakes.

    Attributes:
        mistakes: One line each, which begins with the file name.
        file: The decoded robot.toml without its unknown keys; None if it cannot be decoded.
        model: The compiled MJCF; None if it is invalid.
        robot: The robot; None if there are mistakes other than unknown keys.
        unlimited: Joints for which robot.toml omits a limit.
    """

    mistakes: tuple[str, ...]
    file: RobotFile | None = None
    model: mujoco.MjModel | None = None
    robot: RobotDescription | None = None
    unlimited: tuple[str, ...] = ()


def read_folder(folder: Path) -> FolderContents:
    """Return the valid parts and all mistakes of the robot in `folder`."""
    try:
        data = read_toml(folder / FILE)
    except ConfigError as error:
        mistakes, model = _model(folder, MODEL, None)
        return FolderContents((relative(folder, error), *mistakes), model=model)
    wrong, file = decode(FILE, data, RobotFile)
    if file is None:
        named = data.get("model", MODEL)
        mistakes, model = _model(folder, named, None) if isinstance(named, str) else ((), None)
        return FolderContents((*wrong, *mistakes), model=model)
    file = with_drive_defaults(file)
    mistakes, model = _model(folder, file.model, file)
    if model is None:
        return FolderContents((*wrong, *mistakes), file)
    unlimited = tuple(joint.name for joint in file.joint if isnan(joint.lower + joint.upper))
    file = with_mjcf_limits(file, model)
    found = dict.fromkeys(Checks(folder / FILE, file, model).mistakes())
    crossed = tuple(f"{FILE}: {key}: {mistake}" for key, mistake in found)
    sound = not (mistakes or crossed)
    robot = describe(folder, file, model) if sound else None
    return FolderContents((*wrong, *mistakes, *crossed), file, model, robot, unlimited)


def decode(name: str, data: Any, record: type[T]) -> tuple[tuple[str, ...], T | None]:
    """Return the mistakes in the keys of a file, and the record without its unknown keys.

    Args:
        name: Name of the file, for the messages.
        data: The parsed TOML.
        record: Type of the record.

    Returns:
        One line for each mistake; and the record, or None if it cannot be decoded.
    """
    infinite = dict(non_finite_numbers(data))
    found = list(key_mistakes(data, record))
    others = [mistake for mistake in found if mistake.key not in infinite]
    lines = [f"{name}: {key}: {why}" for key, why in infinite.items()]
    lines += [f"{name}: {mistake.key}: {mistake.message}" for mistake in others]
    if infinite or not all(mistake.kind == "unknown" for mistake in found):
        return tuple(lines), None
    return tuple(lines), msgspec.convert(without_unknown(data, found), record)


def relative(folder: Path, error: Exception) -> str:
    """Return an error's message without the path of the folder at its beginning."""
    return str(error).removeprefix(f"{folder}/")


def _model(
    folder: Path, name: str, file: RobotFile | None
) -> tuple[tuple[str, ...], mujoco.MjModel | None]:
    """Return the mistakes of an MJCF, and its model completed with what `file` asks for."""
    path = folder / name
    complete = None if file is None else partial(complete_for, file)
    try:
        model = mjcf.model_of(path, complete)
    except ConfigError as error:
        return (relative(folder, error),), None
    wrong = tuple(f"{name}: {mistake}" for mistake in wrong_numbers(model))
    return wrong, None if wrong else model
