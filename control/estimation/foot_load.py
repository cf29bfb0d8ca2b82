"""Distribution of the weight over the soles' points, by contact sensors or by the kinematics."""

import numpy as np

from windup.control.kinematics.soles import Soles
from windup.hal.contacts import ContactSensors
from windup.hal.joints import Array

SKIN = 2e-3  # height above the lowest point at which a point's load is smaller by a factor e, m
TOUCH = 3e-3  # maximum height of a point in contact above the lowest point, m
FREE_FALL = 3.0  # accelerometer magnitude below which the robot is in free fall, m/s2


class FootLoad:
    """Distributes the weight over the points of the soles.

    Args:
        soles: The soles.
        contacts: The contact sensors.
        weight: Weight of the robot, N.
        sensed: The robot has these sensors; otherwise its lowest points bear the weight.
    """

    def __init__(
        self, soles: Soles, contacts: ContactSensors, weight: float, *, sensed: bool = True
    ) -> None:
        self.soles, self.contacts, self.weight = soles, contacts, weight
        self._sensors = len(contacts.names)
        self._sensed = sensed and self._sensors > 0 and bool((soles.sensor >= 0).all())

    def sensed(self, contacts: Array) -> bool:
        """Return True if `contacts` (k,) N are measured forces."""
        return self._sensed and len(contacts) == self._sensors

    def shares(self, contacts: Array, acceleration: Array) -> Array:
        """Return the points' shares (p,) of the weight, all 0 without ground contact.

        Args:
            contacts: (k,) contact forces, N.
            acceleration: (3,) accelerometer reading, m/s2.
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
        """Return the estimated readings (k,) of contact sensors that the robot lacks, N."""
        heights, sensor = self.soles.heights, self.soles.sensor
        near = (heights - heights.min() < TOUCH) & (shares > 0.0) & (sensor >= 0)
        force = np.zeros(self._sensors)
        force[sensor[near]] = 2.0 * self.contacts.threshold
        known = sensor >= 0
        load = np.bincount(sensor[known], self.weight * shares[known], self._sensors)
        return np.where(force > 0.0, np.maximum(force, load), 0.0)
