"""Rotation and rates from an IMU that reports its attitude at a low rate, without a gyroscope."""

from typing import NamedTuple

import numpy as np

from windup.hal.geometry.quaternion import rotation_between
from windup.hal.joints import Array
from windup.hal.observation import ImuState

LONGEST = 0.05
"""Maximum time of extrapolation of the rates, s."""
SAME = 1e-3
"""Minimum time between two different samples, s."""


class Motion(NamedTuple):
    """Motion since the last call.

    Attributes:
        turn: (3,) rotation vector, rad.
        rate: (3,) present angular velocity, rad/s.
    """

    turn: Array
    rate: Array


class FusedAttitude:
    """Computes rotations from attitude samples, and extrapolates them to the present.

    The mean rate between two samples is taken as the rate at the middle of that interval. The
    rates are extrapolated linearly from the last two intervals.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Start over at the next sample."""
        self._orientation: Array | None = None
        self._sampled = self._half = 0.0
        self._rate, self._slope = np.zeros(3), np.zeros(3)
        self._ahead = np.zeros(3)

    def follow(self, imu: ImuState, sampled: float, now: float) -> Motion:
        """Return the motion since the last call, up to `now`.

        Args:
            imu: The last sample.
            sampled: Timestamp of the sample, s.
            now: Present time, s; later or a little earlier than `sampled`.
        """
        turn = self._turn(imu, sampled) - self._ahead
        lead = min(now - self._sampled, LONGEST)
        self._ahead = lead * (self._rate + (self._half + 0.5 * lead) * self._slope)
        return Motion(turn + self._ahead, self._rate + (self._half + lead) * self._slope)

    def _turn(self, imu: ImuState, sampled: float) -> Array:
        """Return the rotation (3,) since the last sample, rad, and update the rates."""
        last, orientation = self._orientation, imu.orientation
        assert orientation is not None, "an IMU without a gyroscope tells its attitude"
        passed = sampled - self._sampled
        if last is not None and passed < SAME:
            return np.zeros(3)
        self._orientation, self._sampled = orientation, sampled
        if last is None:
            return np.zeros(3)
        turn = rotation_between(last, orientation)
        rate, half = turn / passed, 0.5 * passed
        known = self._half > 0.0 and passed < LONGEST
        self._slope = (rate - self._rate) / (half + self._half) if known else np.zeros(3)
        self._rate, self._half = rate, half
        return turn
