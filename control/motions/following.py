"""Does each joint follow its goal, in direction and rate?

One number decides: how far a joint will be behind its goal in a moment. Loads, friction and play
hold a joint back by some degrees, also one that bears the robot; a joint that is farther behind is
jammed, is not the one that was meant, or has a motor that turns the other way: that one runs away,
which is why its speed counts too. What the joint did meanwhile says what it is.

A servo whose `sign` or `id` is wrong in robot.toml follows all the same: it is read as it is
commanded. What its own encoder cannot tell, the trunk and the other limbs may.
"""

from math import degrees, radians

import numpy as np

from windup.hal.errors import FirstMotionError
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

TICKS = 2
"""So many ticks in a row a joint has to be behind: a single reading may be wrong."""
AHEAD = 0.08
"""How far one looks ahead, s: motors that turn the other way are caught within 15 degrees.

What is foreseen counts for half of what is allowed at most: a load that comes upon a joint at once
throws it back by some degrees as fast.
"""
FRESH = 0.02
"""Age of a reading that still counts, s."""
STILL = radians(3.0)
"""A joint that moved less did not move."""
SHARE = 0.25
"""A joint that has gone less of its way did not follow."""
TOLD = radians(7.0)
"""A joint with a shorter way is not judged by the share of it that it went."""
ALIKE = 0.5
"""A joint that went at least this share of another one's way may have been taken for it."""


class Following:
    """Watches the n joints of a robot on their way from one pose to another.

    Args:
        joints: The joints.
        start: (n,) rad where they begin.
        way: (n,) rad from there to where they go.
        lag: How far a joint may be behind its goal, rad.
    """

    def __init__(self, joints: Joints, start: Array, way: Array, lag: float) -> None:
        self._names, self._start, self._way, self._lag = joints.names, start, way, lag
        self._late = np.zeros(len(joints), dtype=np.int64)
        self._before: list[tuple[float, Array]] = []

    def update(self, observation: Observation, goal: Array) -> None:
        """Judge the joints beside the goals (n,) rad that they have had.

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
        """Judge where the joints have come to rest, positions (n,) rad.

        Raises:
            FirstMotionError: A joint has gone next to nothing of its way.
        """
        gone = (position - self._start) * np.sign(self._way)
        way = np.abs(self._way)
        lame = (way > TOLD) & (gone < SHARE * way)
        if lame.any():
            worst = int(np.where(lame, way - gone, 0.0).argmax())
            raise FirstMotionError(self._said(worst, position, self._start + self._way))

    def _said(self, joint: int, position: Array, goal: Array) -> str:
        """Return what is wrong with a joint, and what to look at."""
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
        """Return which joint went the way of another one without being told to."""
        goals = np.abs(self._way) < STILL
        alike = goals & (np.abs(moved) > ALIKE * abs(told)) & (np.abs(moved) > STILL)
        alike[joint] = False
        return int(np.where(alike, np.abs(moved), 0.0).argmax()) if alike.any() else None
