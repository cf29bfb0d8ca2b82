"""Footprints (target places of the feet, in step order), and their file.

A place is (x m, y m, yaw rad) on the ground; see `windup.control.kinematics.places`.
"""

from dataclasses import dataclass
from math import radians
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
