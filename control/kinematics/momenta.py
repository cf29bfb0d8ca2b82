"""Momenta of the whole body, and points on the ground (CoP, capture point) derived from them.

Equations are those of Wu & Zordan 2010, "Goal-Directed Stepping with Momentum Control". World
frame, z up; points are (2,) m on the ground.
"""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from windup.control.kinematics.computed_once import ComputedOnce
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array

LEAST_LOAD = 0.3
"""Minimum vertical ground force assumed, as a share of the weight, even in free fall."""


@dataclass(frozen=True)
class Momenta:
    """Mass, centre of mass and momenta of the whole body at one instant.

    Attributes:
        mass: Mass, kg.
        com: (3,) centre of mass, m; z is above the ground.
        velocity: (3,) velocity of the centre of mass, m/s.
        angular: (3,) angular momentum about the centre of mass, kg m2/s.
    """

    mass: float
    com: Array
    velocity: Array
    angular: Array

    @property
    def linear(self) -> Array:
        """(3,) linear momentum, kg m/s."""
        return self.mass * self.velocity

    @ComputedOnce
    def omega(self) -> float:
        """Natural frequency of the inverted pendulum of this height, sqrt(g / c_z), 1/s."""
        return sqrt(GRAVITY / max(float(self.com[2]), 1e-3))

    @ComputedOnce
    def capture_point(self) -> Array:
        """(2,) point over which an inverted pendulum comes to rest (Eq. 7), m."""
        return self.com[:2] + self.velocity[:2] / self.omega


def centre_of_pressure(body: Momenta, linear_rate: Array, angular_rate: Array) -> Array:
    """Return the centre of pressure (2,) m for given rates of both momenta (Eq. 1, 2).

    Args:
        body: The momenta.
        linear_rate: (3,) rate of the linear momentum, N.
        angular_rate: (3,) rate of the angular momentum, N m.
    """
    load = _load(body, float(linear_rate[2]))
    return _point(body, linear_rate / load, angular_rate / load)


def desired_cp(body: Momenta, linear_damping: float, angular_damping: float) -> Array:
    """Return the centre of pressure (2,) m that damps both momenta (Eq. 3 to 6).

    Args:
        body: The momenta.
        linear_damping: d_l, 1/s; `Momenta.omega` gives the capture point (section 4.3).
        angular_damping: d_h, 1/s; 0 gives the inverted pendulum.
    """
    linear_rate = -linear_damping * body.linear
    return centre_of_pressure(body, linear_rate, -angular_damping * body.angular)


def capture_point(body: Momenta) -> Array:
    """Return the capture point (2,) m, over which an inverted pendulum comes to rest (Eq. 7)."""
    return body.capture_point


def _load(body: Momenta, rate: float) -> float:
    """Return f_z, the vertical ground force, N, at least `LEAST_LOAD` of the weight."""
    weight = body.mass * GRAVITY
    return max(rate + weight, LEAST_LOAD * weight)


def _point(body: Momenta, linear: Array, angular: Array) -> Array:
    height = body.com[2]
    return np.array(
        [
            body.com[0] - linear[0] * height - angular[1],
            body.com[1] - linear[1] * height + angular[0],
        ]
    )
