"""How fast the base moves over the soles that bear its weight."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from windup.control.kinematics.soles import Soles, spin
from windup.hal.joints import Array

ONES = np.ones(3)


@dataclass(frozen=True)
class FootNoise:
    """How still a sole that bears weight is believed to be; standard deviations.

    Attributes:
        velocity: Of a sole with all the weight on it, m/s.
        rolling: Rate of a foot that doubles the variance: it rocks over an edge, or slaps, rad/s.
        turning: Rate of a still leg's sole about the vertical, rad/s.
    """

    velocity: float = 0.04
    rolling: float = 2.0
    turning: float = 0.005


class Odometry(NamedTuple):
    """What standing soles say about the base.

    Attributes:
        velocity: (3,) m/s of the IMU, seen from the base.
        deviation: Standard deviation of each component, m/s.
        rate: (3,) rad/s of the base if the more loaded sole does not turn, seen from the base.
        rate_deviation: Standard deviation of its part about the vertical, rad/s.
    """

    velocity: Array
    deviation: float
    rate: Array
    rate_deviation: float


def leg_odometry(
    soles: Soles, shares: Array, rate: Array, imu: Array, noise: FootNoise
) -> Odometry | None:
    """Return what the soles say, or None when none bears weight.

    Each foot speaks for the points of it that bear weight, so a foot that rocks over an edge
    speaks for that edge; it counts by its share of the weight, and less when it turns.

    Args:
        soles: The soles.
        shares: (p,) shares of the weight.
        rate: (3,) rad/s of the base, in the base.
        imu: (3,) m, place of the IMU in the base.
        noise: How still soles are.
    """
    share = soles.members @ shares
    if not share.any():
        return None
    place, flow = soles.flow(shares)
    flow += (place - share[:, None] * imu) @ spin(rate).T
    turning = soles.rotation + rate
    # Each foot's velocity is flow / share, its information share / rolling.
    believed = 1.0 / (1.0 + (turning * turning) @ ONES / noise.rolling**2)
    information = float(believed @ share)
    still = soles.rotation[share.argmax()]
    return Odometry(
        (believed @ flow) / -information,
        noise.velocity / information**0.5,
        -still,
        noise.turning + 0.5 * float(still @ still) ** 0.5,
    )
