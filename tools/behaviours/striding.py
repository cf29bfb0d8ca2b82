"""Striding as the inverted pendulum plans it: orders over time, the controller, and how it went."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import atan2, degrees, radians
from typing import Any, Final

import numpy as np

from windup.control.kinematics.rotation import heading
from windup.control.stride.pendulum import VelocityCommand
from windup.control.stride.stride_file import Stride
from windup.control.stride.strider import Strider
from windup.hal.errors import UnknownNameError, UsageError
from windup.hal.joints import Array
from windup.hal.observation import BaseState, Observation
from windup.hal.ranges import Range, read_number
from windup.robots import RobotDescription
from windup.tools.assembly.robot_file import load_beside
from windup.tools.assembly.shape import check_walks
from windup.tools.assembly.state import state_of
from windup.tools.behaviours.directed import limbs_of
from windup.tools.robot.robot import Robot

FILE: Final = "stride.toml"
RAMP = 2.0
"""Time after an order until its speed is measured, s."""
REST = 1.0
"""How long it has to stand at the end, s."""
LATE = 6.0
"""After so long past its time a robot that has not halted never will, s."""
LIMITS: Final = Range(-1e5, 1e5)
"""Numbers that an order may have, in any of their units."""
TICK = 0.05
"""How often it is noted where it is, s."""


@dataclass(frozen=True)
class Leg:
    """An order from a time on; speed m/s, degrees as people give them."""

    begin: float
    speed: float
    heading: float
    face: float

    def order(self) -> VelocityCommand:
        """Return it as the controller takes it."""
        return VelocityCommand(self.speed, radians(self.heading), radians(self.face))


def find_stride(robot: RobotDescription) -> Stride:
    """Return how `robot` strides.

    Raises:
        UsageError: It has no stride.toml.
        ConfigError: That file says something that cannot be.
    """
    how = load_beside(robot, FILE, Stride)
    if how.stance not in robot.poses:
        raise UnknownNameError(f"pose of {robot.name}", how.stance, robot.poses)
    return how


def read_leg(text: str, before: Leg) -> Leg:
    """Return what one --then says, after the leg `before` it.

    >>> read_leg("4,0.1,30", Leg(0.0, 0.05, 0.0, 0.0))
    Leg(begin=4.0, speed=0.1, heading=30.0, face=0.0)

    Raises:
        UsageError: It is written in another way, or does not come later.
    """
    words = text.split(",")
    if not 2 <= len(words) <= 4:
        raise UsageError(f"--then {text}: write SECONDS,SPEED[,HEADING[,FACE]], such as 4,0.1,30")
    numbers = [read_number(f"--then {text}", word, LIMITS) for word in words]
    if numbers[0] <= before.begin:
        raise UsageError(f"--then {text}: give a time after {before.begin:g} s")
    rest = [before.heading, before.face]
    rest[: len(numbers) - 2] = numbers[2:]
    return Leg(numbers[0], numbers[1], *rest)


def check_legs(legs: Sequence[Leg], seconds: float, how: Stride) -> None:
    """Raise where a robot cannot do what is ordered.

    Raises:
        UsageError: A speed or a time cannot be.
    """
    for leg in legs:
        if not 0.0 <= leg.speed <= how.fastest:
            raise UsageError(f"speed {leg.speed:g} m/s: give 0 .. {how.fastest:g}")
    if not legs[-1].begin < seconds:
        raise UsageError(f"--seconds {seconds:g}: give more than {legs[-1].begin:g}")


def build_strider(robot: RobotDescription, legs: Sequence[Leg], seconds: float) -> Strider:
    """Return the controller that follows the `legs` for `seconds` s and halts.

    Raises:
        UsageError: The robot has no stride.toml, or not two feet.
    """
    check_walks(robot, "stride")
    how = find_stride(robot)
    begins = [leg.begin for leg in legs]

    def orders(time: float) -> VelocityCommand:
        order = legs[max(bisect_right(begins, time + 1e-9) - 1, 0)].order()
        return order if time < seconds else VelocityCommand(0.0, order.heading, order.face)

    limbs, stance = limbs_of(robot), robot.poses[how.stance]
    return Strider(robot.joints, state_of(robot), limbs, stance, orders, how)


@dataclass
class StrideTrace:
    """Where a robot goes while it strides; a twin is measured by its truth.

    Attributes:
        robot: The robot, in its start pose.
        strider: Its controller.
        legs: What it is ordered to do.
        seconds: When it is to halt, s.
        reason: Why the run ended.
        rows: Time s, x m, y m, yaw rad.
    """

    robot: Robot
    strider: Strider
    legs: Sequence[Leg]
    seconds: float
    reason: str = "interrupted"
    rows: list[list[float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._origin, self._halted = self.robot.backend.clock.now(), 0.0

    def until(self, observation: Observation) -> str | None:
        """Look at a tick; return why the run is over, or None."""
        time = observation.time - self._origin
        twin, rows = self.robot.stack.twin, self.rows
        base = observation.base if twin is None else twin.base
        if base is not None and (not rows or time - rows[-1][0] >= TICK - 1e-9):
            rows.append([time, *_place(base)])
        if self.strider.phase != "stand" or time < self.seconds:
            self._halted = time
        if time - self._halted >= REST and time >= self.seconds + REST:
            return "done"
        return "does not halt" if time > self.seconds + LATE else None

    def result(self) -> dict[str, Any]:
        """Return how it went."""
        robot, trace = self.robot, np.array(self.rows).reshape(-1, 4)
        moved = _seen(trace[0], trace[-1]) if len(trace) else np.zeros(3)
        ends = _ends(self.legs, self.seconds)
        return {
            "robot": robot.description.name,
            "seed": robot.seed,
            "good": self.reason == "done",
            "reason": self.reason,
            "steps": self.strider.steps,
            "seconds": robot.loop.sim_time,
            "moved_m": moved[:2].tolist(),
            "turned_deg": degrees(moved[2]),
            "legs": [_measured(leg, end, trace) for leg, end in zip(self.legs, ends, strict=True)],
            "tick_ms": robot.loop.tick_ms(),
        }


def stride(trace: StrideTrace) -> None:
    """Let a robot stride until it halts, and trace where it goes.

    Raises:
        WindupError: From the loop.
        KeyboardInterrupt: Somebody stopped it.
    """
    run = trace.robot.run(trace.strider, until=trace.until, needs_imu=True)
    trace.reason = run.reason


def _ends(legs: Sequence[Leg], seconds: float) -> list[float]:
    return [*(leg.begin for leg in legs[1:]), seconds]


def _measured(leg: Leg, end: float, trace: Array) -> dict[str, Any]:
    """Return a leg beside what came of it, once it had got going."""
    part = trace[(trace[:, 0] >= leg.begin + RAMP) & (trace[:, 0] <= end)]
    row: dict[str, Any] = {"begin": leg.begin, "speed": leg.speed, "heading": leg.heading}
    if len(part) < 2 or part[-1, 0] <= part[0, 0]:
        return row | {"measured_speed": None, "measured_heading": None}
    # The weight sways from foot to foot: a line through all of it says where it goes.
    velocity = np.polyfit(part[:, 0], part[:, 1:3], 1)[0]
    way = degrees(atan2(velocity[1], velocity[0]) - trace[0, 3])
    speed = float(np.hypot(*velocity))
    return row | {"measured_speed": speed, "measured_heading": (way + 180.0) % 360.0 - 180.0}


def _place(base: BaseState) -> list[float]:
    return [float(base.position[0]), float(base.position[1]), float(heading(base.orientation))]


def _seen(start: Array, end: Array) -> Array:
    """Return (3,) where the end of a trace is, seen from its start: x, y m, yaw rad."""
    away, yaw = end[1:3] - start[1:3], start[3]
    c, s = np.cos(yaw), np.sin(yaw)
    turned = end[3] - yaw
    return np.array(
        [
            c * away[0] + s * away[1],
            c * away[1] - s * away[0],
            atan2(np.sin(turned), np.cos(turned)),
        ]
    )
