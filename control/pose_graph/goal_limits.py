"""Limits of goal positions: the joint's range, and the firmware's maximum goal speed."""

import numpy as np

from windup.hal.joints import Array, Joints


class GoalLimits:
    """Limits goal positions, and their change per tick.

    A servo whose firmware limits the speed of its goal would lag behind a goal that jumps, and the
    rollouts do not model firmware. So no goal changes faster than `Joints.goal_speed`.

    Args:
        joints: The joints.
    """

    def __init__(self, joints: Joints) -> None:
        self._lower, self._upper, self._speed = joints.lower, joints.upper, joints.goal_speed
        self._endless = bool(np.isinf(joints.goal_speed).all())

    def apply(self, goals: Array, before: Array | None, dt: float) -> Array:
        """Return the limited goals (..., n), rad.

        Args:
            goals: (..., n) desired goals, rad.
            before: (..., n) limited goals of the last tick, rad; None if there was none.
            dt: Time since then, s.
        """
        goals = np.minimum(np.maximum(goals, self._lower), self._upper)
        if before is None or self._endless:
            return goals
        reach = self._speed * dt
        return np.minimum(np.maximum(goals, before - reach), before + reach)
