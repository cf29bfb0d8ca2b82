"""Rotation and rates of an IMU that tells its attitude, now and then, and has no gyroscope."""

from typing import NamedTuple

import numpy as np

from windup.hal.imu.quaternion import between
from windup.hal.joints import Array
from windup.hal.observation import ImuState

LONGEST = 0.05
"""Time over which the change of the rates is carried on at most, s."""
SAME = 1e-3
"""Two samples that are not so far apart in time are one, s."""


class Motion(NamedTuple):
    """What has happened since the last look.

    Attributes:
        turn: (3,) rotation, rad.
        rate: (3,) rad/s now.
    """

    turn: Array
    rate: Array


class FusedAttitude:
    """Follows the attitude from sample to sample, and carries it on to the present.

    The rates between two samples are those of half the time in between. They go on changing as
    they did from one pair to the next.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Begin anew with the next sample."""
        self._orientation: Array | None = None
        self._sampled = self._half = 0.0
        self._rate, self._slope = np.zeros(3), np.zeros(3)
        self._ahead = np.zeros(3)

    def follow(self, imu: ImuState, sampled: float, now: float) -> Motion:
        """Return the motion up to `now` s.

        Args:
            imu: The last sample.
            sampled: When it was taken, s.
            now: s; later or a little earlier than that.
        """
        turn = self._turn(imu, sampled) - self._ahead
        lead = min(now - self._sampled, LONGEST)
        self._ahead = lead * (self._rate + (self._half + 0.5 * lead) * self._slope)
        return Motion(turn + self._ahead, self._rate + (self._half + lead) * self._slope)

    def _turn(self, imu: ImuState, sampled: float) -> Array:
        """Return the rotation (3,) since the last sample, rad, and take its rates."""
        last, orientation = self._orientation, imu.orientation
        assert orientation is not None, "an IMU without a gyroscope tells its attitude"
        passed = sampled - self._sampled
        if last is not None and passed < SAME:
            return np.zeros(3)
        self._orientation, self._sampled = orientation, sampled
        if last is None:
            return np.zeros(3)
        turn = between(last, orientation)
        rate, half = turn / passed, 0.5 * passed
        known = self._half > 0.0 and passed < LONGEST
        self._slope = (rate - self._rate) / (half + self._half) if known else np.zeros(3)
        self._rate, self._half = rate, half
        return turn
