"""Prediction of falls that no step can prevent, by the capture point.

A robot that does not step falls as soon as its capture point has left its soles. One that steps
prevents the fall if it can put a foot there: so a fall is certain once the capture point is
farther outside the soles' hull than a step reaches (Kenwright 2012, algorithm V-1, case C). The
criterion covers tilt and tilt rate: a robot that tips about an edge of its soles moves its centre
of mass outwards, and the capture point adds the velocity of that.
"""

from math import atan2, cos, hypot, sin

import numpy as np

from windup.control.kinematics.momenta import Momenta, capture_point
from windup.control.kinematics.robot_state import RobotState
from windup.control.kinematics.support import SupportRegion
from windup.hal.errors import StateMissingError
from windup.hal.joints import Array
from windup.hal.observation import Observation

CONFIRM = 0.006
"""Minimum time of the capture point out of reach, s: one noisy sample is not a fall."""


def unreachable(body: Momenta, soles: Array, reach: float) -> Array | None:
    """Return the direction (2,) of the fall from the soles, m, or None if a step can prevent it.

    Args:
        body: The momenta.
        soles: (p, 2) points of the soles, m, whether or not they bear load.
        reach: Maximum distance outside their hull at which a foot can be put, m.
    """
    point = capture_point(body)
    away = point - soles
    if (away * away).sum(axis=1).min() <= reach * reach:
        return None  # within reach of a corner: the hull is not needed
    if SupportRegion.hull(soles).margin(point) >= -reach:
        return None
    centre = 0.5 * (soles.min(axis=0) + soles.max(axis=0))
    return np.asarray(point - centre)


class FallPredictor:
    """Detects in the observations of one robot a fall that cannot be prevented.

    Args:
        state: The robot's state, with the points of its soles.
        reach: Maximum distance outside the hull of its soles at which it can put a foot, m.

    Attributes:
        toward: Direction of the predicted fall, rad from straight ahead, positive to the left,
            in -pi .. pi; None as long as no fall is predicted.
    """

    def __init__(self, state: RobotState, reach: float) -> None:
        self.reach = reach
        self._state = state
        _ = state.soles  # made now, and not in the first tick
        self.reset()

    def reset(self) -> None:
        """Start over, with no fall predicted."""
        self.toward: float | None = None
        self._since: float | None = None

    def update(self, observation: Observation) -> bool:
        """Return whether a fall is certain; once it is, it stays so until `reset`.

        Raises:
            StateMissingError: The observation has no base.
        """
        if self.toward is not None:
            return True
        way = self._way(observation)
        if way is None:
            self._since = None
        elif self._since is None:
            self._since = observation.time
        elif observation.time >= self._since + CONFIRM:
            self.toward = atan2(way[1], way[0])
        return self.toward is not None

    def _way(self, observation: Observation) -> Array | None:
        """Return the unit direction (2,) of a certain fall (ahead, left), or None."""
        if observation.base is None:
            raise StateMissingError(
                "a fall cannot be foreseen without the base state; give the robot an [imu] and a "
                "[[foot]] in robot.toml, or run with --no-protect"
            )
        state = self._state.update(observation)
        way = unreachable(state.momenta, state.ground[:, :2], self.reach)
        if way is None:
            return None
        c, s = cos(state.yaw), sin(state.yaw)
        return np.array([c * way[0] + s * way[1], c * way[1] - s * way[0]]) / hypot(*way)
