"""Checks of references between a gait file's tables; every error names the file and the key."""

from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path

from windup.control.pose_graph.gait_file import GaitFile
from windup.control.regulation.variables import regulation_variables
from windup.hal.errors import ConfigError, UnknownNameError
from windup.hal.joints import Joints


def check_gait(path: Path, file: GaitFile, joints: Joints) -> None:
    """Check the names by which the tables of a gait file refer to each other and to the joints.

    Raises:
        ConfigError: A table refers to an unknown name, is empty, or contradicts another one.
    """
    names = [item.name for item in file.perturbation]
    parts = [(item.name, item.states and sorted(item.states)) for item in file.perturbation]
    for number, (name, states) in enumerate(parts):
        if (name, states) in parts[:number]:
            why = "this name stands twice; give each its own, or other states"
            raise _error(path, f"perturbation.{name}", why)
    if file.balance is not None:
        _known(path, "balance.perturbations", file.balance.perturbations, names)
        try:
            regulation_variables([*file.balance.regulation, *file.balance.targets])
        except UnknownNameError as error:
            raise _error(path, "balance.regulation", str(error)) from None
    if file.speed is not None:
        _check_speed(path, file, names)
    if file.side is not None:
        _known(path, "side.scale", file.side.scale, names)
        _known(path, "side.spread", file.side.spread, names)
    if file.heading is not None:
        _known(path, "heading.perturbation", [file.heading.perturbation], names)
    if file.turn is not None:
        _known(path, "turn.perturbation", filter(None, [file.turn.perturbation]), names)
        _known(path, "turn.spread", file.turn.spread, names)
    if file.incline is not None:
        _known(path, "incline.perturbation", [file.incline.perturbation], names)
    if file.slip is not None:
        named = [style.name for style in file.style]
        _known(path, "slip.style", [file.slip.style], [*named, *names], "style")
        _known(path, "slip.states", file.slip.states, [s.name for s in file.state], "state")
    for style in file.style:
        _known(path, f"style.{style.name}.scale", style.scale, names)
    if file.torso_servo is not None:
        _known(path, "torso_servo.joint", [file.torso_servo.joint], joints.names, "joint")
    if file.staged:
        _check_stages(path, file, joints)


def _check_stages(path: Path, file: GaitFile, joints: Joints) -> None:
    """Check the keys `move`, `reach` and `upright`, which only a graph that is played can have."""
    if file.balance is not None or file.mirror:
        raise _error(
            path, "state", "`move`, `reach` and `upright` are for graphs without balance and mirror"
        )
    names = [state.name for state in file.state]
    if file.upright is not None:
        _known(path, "upright.states", file.upright.states or [], names, "state")
        for key in ("forward", "forward_rate", "right", "right_rate"):
            _known(path, f"upright.{key}", getattr(file.upright, key), joints.names, "joint")
    for state in file.state:
        where = f"state.{state.name}"
        if state.until.time is None:
            raise _error(
                path, f"{where}.until", "beside `move`, `reach` and `upright`, give a `time`"
            )
        if not 0.0 <= state.move <= state.until.time:
            why = f"{state.move:g} s do not fit into the state's {state.until.time:g} s"
            raise _error(path, f"{where}.move", why)
        if state.reach is not None and state.reach.again is not None:
            _known(path, f"{where}.reach.again", [state.reach.again], names, "state")


def _check_speed(path: Path, file: GaitFile, names: list[str]) -> None:
    assert file.speed is not None
    speeds = [row.speed for row in file.speed.rows]
    if not speeds:
        raise _error(path, "speed.rows", "a speed table needs at least one row")
    if any(after <= before for before, after in pairwise(speeds)):
        raise _error(path, "speed.rows", "the speeds have to rise from row to row")
    for row in file.speed.rows:
        _known(path, "speed.rows.scale", row.scale, names)


def _known(
    path: Path,
    key: str,
    wanted: Iterable[str],
    known: Iterable[str],
    kind: str = "perturbation",
) -> None:
    for name in wanted:
        if name not in known:
            raise _error(path, key, str(UnknownNameError(kind, name, known)))


def _error(path: Path, key: str, message: str) -> ConfigError:
    return ConfigError(f"{path}: {key}: {message}")
