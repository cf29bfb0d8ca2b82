"""Footprints (target places of the feet, in step order), their file, and operations on places.

A place is (x m, y m, yaw rad) on the ground: x forward, y to the left, yaw to the left.
"""

from dataclasses import dataclass
from math import atan2, cos, radians, sin
from pathlib import Path
from typing import Literal

import numpy as np

from windup.hal.config import Positive, TomlRecord, load_toml
from windup.hal.errors import UnknownNameError, UsageError
from windup.hal.joints import Array
from windup.hal.mirror import side_of

Frame = Literal["stance", "start"]


class StepRecord(TomlRecord, frozen=True, kw_only=True):
    """One `[[step]]` of a footprint file; metres, degrees and seconds."""

    foot: str
    x: float
    y: float
    yaw: float = 0.0
    duration: Positive | None = None


class FootprintFile(TomlRecord, frozen=True, kw_only=True):
    """A footprint file.

    Attributes:
        frame: "stance": x, y and yaw are relative to the stance foot as measured at that step;
            "start": relative to the middle between both feet at the start.
        step: The steps in order.
    """

    frame: Frame = "stance"
    step: list[StepRecord]


@dataclass(frozen=True)
class Footprint:
    """Target place of one foot.

    Attributes:
        foot: Index of the foot.
        place: (3,) x m, y m, yaw rad.
        frame: Frame of the place; see `FootprintFile`.
        duration: Duration of the swing, s; None takes the controller's default.
    """

    foot: int
    place: Array
    frame: Frame = "stance"
    duration: float | None = None


def read_footprints(path: Path, feet: tuple[str, ...]) -> list[Footprint]:
    """Return the footprints of a file, for a robot with these feet.

    Raises:
        ConfigError: The file cannot be read, or is no footprint file.
        UsageError: It has no step, or names a foot that the robot does not have.
    """
    file = load_toml(path, FootprintFile)
    if not file.step:
        raise UsageError(f"{path}: it has no step; give at least one [[step]]")
    prints = []
    for number, row in enumerate(file.step, 1):
        try:
            prints.append(footprint(row, file.frame, feet))
        except UsageError as error:
            raise UsageError(f"{path}: step {number}: {error}") from None
    return prints


def footprint(row: StepRecord, frame: Frame, feet: tuple[str, ...]) -> Footprint:
    """Return the footprint of one row of the file, for a robot with these feet.

    Raises:
        UsageError: The robot has no such foot.
    """
    place = np.array([row.x, row.y, radians(row.yaw)])
    return Footprint(foot_index(row.foot, feet), place, frame, row.duration)


def foot_index(name: str, feet: tuple[str, ...]) -> int:
    """Return the index of a foot; "left" also stands for "left_foot" or "left_hand".

    Raises:
        UsageError: There is no such foot.
    """
    short = [_short(foot) for foot in feet]
    for names in (feet, short):
        if name in names:
            return names.index(name)
    raise UnknownNameError("foot", name, short)


def _short(foot: str) -> str:
    return side_of(foot) or foot


def write_footprints(prints: list[Footprint], feet: tuple[str, ...]) -> str:
    """Return the text of a footprint file; all footprints must have the same frame."""
    lines = [f'frame = "{prints[0].frame}"']
    for one in prints:
        x, y, yaw = one.place
        lines += ["", "[[step]]", f'foot = "{_short(feet[one.foot])}"']
        lines += [f"x = {x:.4f}", f"y = {y:.4f}", f"yaw = {np.degrees(yaw):.2f}"]
        if one.duration is not None:
            lines.append(f"duration = {one.duration:g}")
    return "\n".join(lines) + "\n"


def onto(frame: Array, place: Array) -> Array:
    """Return `place` (3,), given relative to `frame` (3,), in the frame that `frame` is in."""
    x, y, yaw = frame
    c, s = cos(yaw), sin(yaw)
    turned = [x + c * place[0] - s * place[1], y + s * place[0] + c * place[1], yaw + place[2]]
    return np.array(turned)


def seen_from(frame: Array, place: Array) -> Array:
    """Return `place` (3,) relative to `frame` (3,); its yaw is in -pi .. pi."""
    c, s = cos(frame[2]), sin(frame[2])
    dx, dy, turn = place - frame
    return np.array([c * dx + s * dy, -s * dx + c * dy, atan2(sin(turn), cos(turn))])


def between(one: Array, other: Array) -> Array:
    """Return the place (3,) halfway between two places (3,)."""
    away = seen_from(one, other)
    middle = onto(one, np.array([0.0, 0.0, 0.5 * away[2]]))
    middle[:2] = 0.5 * (one[:2] + other[:2])
    return middle


def ground_places(position: Array, frames: Array) -> Array:
    """Return the places (k, 3) of soles, from their positions (k, 3) m and axes (k, 9)."""
    axes = frames.reshape(-1, 3, 3)
    yaw = np.arctan2(axes[:, 1, 0], axes[:, 0, 0])
    return np.column_stack([position[:, :2], yaw])
