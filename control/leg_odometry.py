"""How fast the base moves over the soles that bear its weight."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from control.soles import Soles, cross
from hal.joints import Array


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
    turning: float = 0.02


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
    by_foot = soles.members * shares
    share = by_foot.sum(axis=1)
    if share.sum() <= 0.0:
        return None
    flow = soles.velocity + cross(rate, soles.position - imu)
    turning = soles.rotation + rate
    rolling = 1.0 + (turning * turning).sum(axis=1) / noise.rolling**2
    # Each foot's flow is by_foot @ flow / share, its information share / (velocity^2 rolling).
    information = float((share / rolling).sum())
    velocity = -((1.0 / rolling) @ (by_foot @ flow)) / information
    foot = int(share.argmax())
    still = soles.rotation[foot]
    return Odometry(
        velocity,
        noise.velocity / information**0.5,
        -still,
        noise.turning + 0.5 * float((still @ still) ** 0.5),
    )
