"""A robot's folder, read as far as it can be: all its mistakes at once, and what is left of it."""

from dataclasses import dataclass
from functools import partial
from math import isnan
from pathlib import Path
from typing import Any, TypeVar

import msgspec
import mujoco

from windup.hal.config import not_finite, read_toml
from windup.hal.errors import ConfigError
from windup.hal.key_mistakes import key_mistakes, without_unknown
from windup.robots import mjcf
from windup.robots.checks import Checks
from windup.robots.completion import complete_for
from windup.robots.description import FILE, RobotDescription, describe, filled_in, limited
from windup.robots.mjcf_numbers import wrong_numbers
from windup.robots.records import RobotFile

T = TypeVar("T")
MODEL = "model.xml"


@dataclass(frozen=True)
class Reading:
    """What could be read of a robot's folder.

    Attributes:
        mistakes: What cannot be: one line each, which begins with the file.
        file: What robot.toml says, unknown keys left out; None where it cannot be understood.
        model: The MJCF, compiled; None where it cannot be.
        robot: The robot; None where anything but an unknown key is wrong.
        unlimited: Joints whose limits robot.toml leaves to the MJCF, or to their servo.
    """

    mistakes: tuple[str, ...]
    file: RobotFile | None = None
    model: mujoco.MjModel | None = None
    robot: RobotDescription | None = None
    unlimited: tuple[str, ...] = ()


def read_folder(folder: Path) -> Reading:
    """Return what can be read of the robot in `folder`, and everything that cannot be."""
    try:
        data = read_toml(folder / FILE)
    except ConfigError as error:
        mistakes, model = _model(folder, MODEL, None)
        return Reading((relative(folder, error), *mistakes), model=model)
    wrong, file = understood(FILE, data, RobotFile)
    if file is None:
        named = data.get("model", MODEL)
        mistakes, model = _model(folder, named, None) if isinstance(named, str) else ((), None)
        return Reading((*wrong, *mistakes), model=model)
    file = filled_in(file)
    mistakes, model = _model(folder, file.model, file)
    if model is None:
        return Reading((*wrong, *mistakes), file)
    unlimited = tuple(joint.name for joint in file.joint if isnan(joint.lower + joint.upper))
    file = limited(file, model)
    found = dict.fromkeys(Checks(folder / FILE, file, model).mistakes())
    crossed = tuple(f"{FILE}: {key}: {mistake}" for key, mistake in found)
    sound = not (mistakes or crossed)
    robot = describe(folder, file, model) if sound else None
    return Reading((*wrong, *mistakes, *crossed), file, model, robot, unlimited)


def understood(name: str, data: Any, record: type[T]) -> tuple[tuple[str, ...], T | None]:
    """Return all mistakes of the keys of a file, and what it says without the unknown ones.

    Args:
        name: The file's name, for the messages.
        data: What it says.
        record: What it should say.
    """
    infinite = dict(not_finite(data))
    found = list(key_mistakes(data, record))
    others = [mistake for mistake in found if mistake.key not in infinite]
    lines = [f"{name}: {key}: {why}" for key, why in infinite.items()]
    lines += [f"{name}: {mistake.key}: {mistake.message}" for mistake in others]
    if infinite or not all(mistake.unknown for mistake in found):
        return tuple(lines), None
    return tuple(lines), msgspec.convert(without_unknown(data, found), record)


def relative(folder: Path, error: Exception) -> str:
    """Return an error's message without the folder that it begins with."""
    return str(error).removeprefix(f"{folder}/")


def _model(
    folder: Path, name: str, file: RobotFile | None
) -> tuple[tuple[str, ...], mujoco.MjModel | None]:
    """Return the mistakes of an MJCF, and the model with what `file` adds to it."""
    path = folder / name
    complete = None if file is None else partial(complete_for, file)
    try:
        model = mjcf.model_of(path, complete)
    except ConfigError as error:
        return (relative(folder, error),), None
    wrong = tuple(f"{name}: {mistake}" for mistake in wrong_numbers(model))
    return wrong, None if wrong else model
