"""Leg odometry: the velocity of the base relative to the soles that bear its weight."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from windup.control.kinematics.soles import Soles, spin
from windup.hal.joints import Array

ONES = np.ones(3)


@dataclass(frozen=True)
class FootNoise:
    """Noise model of a sole that bears weight; standard deviations.

    Attributes:
        velocity: Velocity of a sole that bears all the weight, m/s.
        rolling: Angular speed of a foot that doubles the variance, rad/s: it rocks over an edge,
            or slaps on the ground.
        turning: Rate about the vertical of a sole whose leg does not move, rad/s.
    """

    velocity: float = 0.04
    rolling: float = 2.0
    turning: float = 0.005


class Odometry(NamedTuple):
    """Velocities of the base, measured by the soles that bear weight.

    Attributes:
        velocity: (3,) velocity of the IMU in the base frame, m/s.
        deviation: Standard deviation of each component, m/s.
        rate: (3,) angular velocity of the base in the base frame, rad/s, assuming that the more
            loaded sole does not turn.
        rate_deviation: Standard deviation of its component about the vertical, rad/s.
    """

    velocity: Array
    deviation: float
    rate: Array
    rate_deviation: float


def leg_odometry(
    soles: Soles, shares: Array, rate: Array, imu: Array, noise: FootNoise
) -> Odometry | None:
    """Return the leg odometry, or None if no sole bears weight.

    The velocity of each foot is the weighted mean over its points, so for a foot that rocks over
    an edge it is that of the edge. Feet are weighted by their share of the load, less if they turn.

    Args:
        soles: The soles.
        shares: (p,) the points' shares of the weight.
        rate: (3,) angular velocity of the base in the base frame, rad/s.
        imu: (3,) position of the IMU in the base frame, m.
        noise: Noise model of the soles.
    """
    share = soles.members @ shares
    if not share.any():
        return None
    place, flow = soles.flow(shares)
    flow += (place - share[:, None] * imu) @ spin(rate).T
    turning = soles.rotation + rate
    # Each foot's velocity is flow / share; its information is share times `believed`.
    believed = 1.0 / (1.0 + (turning * turning) @ ONES / noise.rolling**2)
    information = float(believed @ share)
    still = soles.rotation[share.argmax()]
    return Odometry(
        (believed @ flow) / -information,
        noise.velocity / information**0.5,
        -still,
        noise.turning + 0.5 * float(still @ still) ** 0.5,
    )
