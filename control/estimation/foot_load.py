"""Which points of the soles bear the weight: from contact sensors, or from where the soles are."""

import numpy as np

from windup.control.kinematics.soles import Soles
from windup.hal.contacts import ContactSensors
from windup.hal.joints import Array

SKIN = 2e-3  # a point bears less by a factor e for each such height above the lowest one, m
TOUCH = 3e-3  # a point not higher than this above the lowest one touches, m
FREE_FALL = 3.0  # who feels less acceleration than this stands on nothing, m/s2


class FootLoad:
    """Shares the weight among the points of the soles.

    Args:
        soles: The soles.
        contacts: The contact sensors.
        sensed: The robot has these sensors; without, its lowest points bear the weight.
        weight: Weight of the robot, N.
    """

    def __init__(
        self, soles: Soles, contacts: ContactSensors, weight: float, *, sensed: bool = True
    ) -> None:
        self.soles, self.contacts, self.weight = soles, contacts, weight
        self._sensors = len(contacts.names)
        self._sensed = sensed and self._sensors > 0 and bool((soles.sensor >= 0).all())

    def sensed(self, contacts: Array) -> bool:
        """Return True when `contacts` (k,) N can be believed."""
        return self._sensed and len(contacts) == self._sensors

    def shares(self, contacts: Array, acceleration: Array) -> Array:
        """Return (p,) shares of the weight, all 0 when the robot stands on nothing.

        Args:
            contacts: (k,) N.
            acceleration: (3,) m/s2, as the accelerometer has it.
        """
        heights = self.soles.heights
        near = np.exp((heights.min() - heights) / SKIN)
        if not self.sensed(contacts):
            falling = acceleration @ acceleration < FREE_FALL**2
            return np.zeros_like(near) if falling else near / near.sum()
        force = np.where(contacts > self.contacts.threshold, contacts, 0.0)
        total = force.sum()
        if total <= 0.0:
            return np.zeros_like(near)
        near += 1e-12
        sensor = self.soles.sensor
        around = np.bincount(sensor, near, self._sensors)
        return (force / (total * around))[sensor] * near

    def forces(self, shares: Array) -> Array:
        """Return (k,) N: what contact sensors would say where there are none."""
        heights, sensor = self.soles.heights, self.soles.sensor
        near = (heights - heights.min() < TOUCH) & (shares > 0.0) & (sensor >= 0)
        force = np.zeros(self._sensors)
        force[sensor[near]] = 2.0 * self.contacts.threshold
        known = sensor >= 0
        load = np.bincount(sensor[known], self.weight * shares[known], self._sensors)
        return np.where(force > 0.0, np.maximum(force, load), 0.0)
