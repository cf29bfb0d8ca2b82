"""Check that each joint follows its goal, in direction and rate.

The criterion is the predicted position error of a joint. Load, friction and backlash cause errors
of some degrees, even in a joint that bears the robot. A larger error means that the joint is
jammed, that another joint was commanded, or that the motor turns the other way. Such a motor runs
away, so the rate of the error counts too. The joint's motion until then tells these cases apart.

A servo whose `sign` or `id` is wrong in robot.toml passes this check, because it is read as it is
commanded. `Planted` finds such servos by the attitude of the soles.
"""

from math import degrees, radians

import numpy as np

from windup.hal.errors import FirstMotionError
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

TICKS = 2
"""Consecutive ticks with too large an error before a joint fails: a single reading may be wrong."""
AHEAD = 0.08
"""Prediction time of the error, s: motors that turn the other way are caught within 15 degrees.

The predicted increase counts for at most half of the permitted error: a sudden load throws a joint
back by some degrees just as fast.
"""
FRESH = 0.02
"""Maximum age of a reading that is checked, s."""
STILL = radians(3.0)
"""A joint that moved less than this did not move, rad."""
SHARE = 0.25
"""A joint that moved less than this share of its commanded motion did not follow."""
TOLD = radians(7.0)
"""Minimum commanded motion of a joint for the `SHARE` criterion, rad."""
ALIKE = 0.5
"""A joint that moved at least this share of another one's motion may be swapped with it."""


class Following:
    """Checks the n joints of a robot while they move from one pose to another.

    Args:
        joints: The joints.
        start: (n,) start pose, rad.
        way: (n,) commanded motion from there to the end pose, rad.
        lag: Maximum position error of a joint, rad.
    """

    def __init__(self, joints: Joints, start: Array, way: Array, lag: float) -> None:
        self._names, self._start, self._way, self._lag = joints.names, start, way, lag
        self._late = np.zeros(len(joints), dtype=np.int64)
        self._before: list[tuple[float, Array]] = []

    def update(self, observation: Observation, goal: Array) -> None:
        """Check the joints against the goals (n,) rad of this tick.

        Raises:
            FirstMotionError: A joint does not follow.
        """
        state, now = observation.joints, observation.time
        position, behind = state.position, np.abs(goal - state.position)
        soon = behind
        if self._before and now > self._before[0][0]:
            then, less = self._before[0]
            speed = np.maximum(behind - less, 0.0) / (now - then)
            soon = behind + np.minimum(AHEAD * speed, 0.5 * self._lag)
        self._before = [*self._before[-1:], (now, behind)]
        fine = (soon < self._lag) | (state.age > FRESH)
        self._late = np.where(fine, 0, self._late + 1)
        late = self._late >= TICKS
        if late.any():
            worst = int(np.where(late, behind, 0.0).argmax())
            raise FirstMotionError(self._said(worst, position, goal))

    def conclude(self, position: Array) -> None:
        """Check the final positions (n,) rad of the joints.

        Raises:
            FirstMotionError: A joint has made less than `SHARE` of its commanded motion.
        """
        gone = (position - self._start) * np.sign(self._way)
        way = np.abs(self._way)
        lame = (way > TOLD) & (gone < SHARE * way)
        if lame.any():
            worst = int(np.where(lame, way - gone, 0.0).argmax())
            raise FirstMotionError(self._said(worst, position, self._start + self._way))

    def _said(self, joint: int, position: Array, goal: Array) -> str:
        """Return the message for a joint that failed: the symptom and what to check."""
        name, moved = self._names[joint], position - self._start
        told = goal[joint] - self._start[joint]
        along = moved[joint] * np.sign(told) if told else -abs(moved[joint])
        if along < -STILL:
            if abs(told) < STILL:
                return (
                    f"{name} turned {degrees(abs(moved[joint])):.0f} degrees though it was told to "
                    "stay: is its motor wired the other way, or is something too heavy for it?"
                )
            return (
                f"{name} turns the other way ({degrees(moved[joint]):+.0f} degrees for "
                f"{degrees(told):+.0f}): is its sign right in robot.toml, and its motor's wiring?"
            )
        if along < max(SHARE * abs(told), STILL):
            other = self._instead(joint, moved, told)
            if other is not None:
                return (
                    f"{name} was told to move and {self._names[other]} moved: are their ids "
                    "swapped in robot.toml?"
                )
            return f"{name} does not follow: is it blocked, or its horn loose?"
        return (
            f"{name} is {degrees(abs(goal[joint] - position[joint])):.0f} degrees behind its goal: "
            "is it stiff, or is something too heavy for it?"
        )

    def _instead(self, joint: int, moved: Array, told: float) -> int | None:
        """Return the joint that moved instead of `joint`, without being commanded, or None."""
        goals = np.abs(self._way) < STILL
        alike = goals & (np.abs(moved) > ALIKE * abs(told)) & (np.abs(moved) > STILL)
        alike[joint] = False
        return int(np.where(alike, np.abs(moved), 0.0).argmax()) if alike.any() else None
