"""Goals that a servo can take: within its joint's limits, and no faster than its firmware runs."""

import numpy as np

from windup.hal.joints import Array, Joints


class GoalLimits:
    """Limits target positions.

    A servo whose firmware lets its goal run at some speed only would lag behind a goal that jumps;
    rollouts know nothing of firmware. So no goal goes further in a tick than such a servo follows.

    Args:
        joints: The joints.
    """

    def __init__(self, joints: Joints) -> None:
        self._lower, self._upper, self._speed = joints.lower, joints.upper, joints.goal_speed
        self._endless = bool(np.isinf(joints.goal_speed).all())

    def apply(self, goals: Array, before: Array | None, dt: float) -> Array:
        """Return targets (..., n) rad.

        Args:
            goals: (..., n) wanted targets, rad.
            before: (..., n) targets of the last tick, rad; None if there was none.
            dt: Time since then, s.
        """
        goals = np.minimum(np.maximum(goals, self._lower), self._upper)
        if before is None or self._endless:
            return goals
        reach = self._speed * dt
        return np.minimum(np.maximum(goals, before - reach), before + reach)
