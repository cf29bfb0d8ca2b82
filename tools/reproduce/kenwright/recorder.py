"""What is noted of a robot under pushes: where its weight and its feet are, tick by tick."""

from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from windup.control.execution.footing import Footing
from windup.control.kinematics.momenta import capture_point
from windup.control.kinematics.rotation import yaw_of
from windup.control.stepping.stepper import Stepper
from windup.hal.controller import Controller
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.tools.reproduce.study.figure import Result
from windup.tools.robot.robot import Robot

EVERY = 2  # ticks
PHASES: Final = ("stand", "swing", "land", "comfort")
NAMES: Final = (
    *("time", "phase", "com.x", "com.y", "cp.x", "cp.y", "yaw"),
    *(f"{foot}.{what}" for foot in ("left", "right") for what in ("x", "y", "z", "yaw")),
)
"""Columns of a trace: s, index in PHASES, m, and rad; all of it the twin's truth."""


@dataclass
class Recorder:
    """Notes the twin's truth at every second tick, and each step at its beginning.

    Attributes:
        robot: The robot.
        footing: Its feet.
        rows: The trace.
        steps: The steps that a fall forced: time, foot, the other foot's share of the weight.
    """

    robot: Robot
    footing: Footing
    rows: list[list[float]] = field(default_factory=list)
    steps: list[dict[str, float]] = field(default_factory=list)
    ticks: int = 0

    def __call__(self, observation: Observation, controller: Controller) -> None:
        """Look at the robot."""
        begun = isinstance(controller, Stepper) and controller.steps > len(self.steps)
        self.ticks += 1
        if self.ticks % EVERY and not begun:
            return
        footing = self.footing
        footing.update(replace(observation, base=self.robot.twin.base))
        phase = PHASES.index(controller.phase) if isinstance(controller, Stepper) else 0
        self.rows.append(self._row(observation.time, phase))
        if begun and isinstance(controller, Stepper):
            foot = controller.stepping_foot
            share = share_of(footing.momenta.com[:2], footing.places, 1 - foot)
            self.steps.append({"time": observation.time, "foot": foot, "share": share})

    def _row(self, time: float, phase: int) -> list[float]:
        footing = self.footing
        com, point = footing.momenta.com[:2], capture_point(footing.momenta)
        row = [time, float(phase), *com.tolist(), *point.tolist(), footing.yaw]
        for pose in footing.feet:
            row += [*pose.position.tolist(), yaw_of(pose.rotation)]
        return row


def share_of(com: Array, places: Array, foot: int) -> float:
    """Return the part of the way from the other foot to `foot` at which the weight is: 0 .. 1."""
    way = places[foot] - places[1 - foot]
    return float(np.clip((com - places[1 - foot]) @ way / max(way @ way, 1e-9), 0.0, 1.0))


def column(result: Result, name: str) -> Array:
    """Return a column of a result's trace."""
    rows = np.array(result["trace"]).reshape(-1, len(NAMES))
    return rows[:, NAMES.index(name)]


def apart(result: Result) -> Array:
    """Return (t, 2) from the right foot to the left one, seen along the trunk's heading, m."""
    way = [column(result, f"left.{axis}") - column(result, f"right.{axis}") for axis in "xy"]
    yaw = column(result, "yaw")
    ahead = np.cos(yaw) * way[0] + np.sin(yaw) * way[1]
    aside = np.cos(yaw) * way[1] - np.sin(yaw) * way[0]
    return np.stack([ahead, aside], axis=-1)
