"""Measurements at every tick of a walk: flight phases, mechanical work, shaking of the base."""

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from windup.hal.contacts import ContactSensors
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Mask
from windup.hal.observation import Observation

SHORTEST_FLIGHT = 0.02  # s; shorter ones are contact chatter


@dataclass
class Gauges:
    """Accumulates measurements from the observations of a walk.

    Attributes:
        contacts: The robot's contact sensors.
        flights: Number of flight phases that ended with a touchdown.
        flight_time: Time in those flight phases, s.
        touchdowns: Index of the foot of each touchdown, in order.
        work: Sum over the joints of the absolute mechanical work, J.
        time: Duration so far, s.
    """

    contacts: ContactSensors
    flights: int = field(default=0, init=False)
    flight_time: float = field(default=0.0, init=False)
    touchdowns: list[int] = field(default_factory=list, init=False)
    work: float = field(default=0.0, init=False)
    time: float = field(default=0.0, init=False)
    _turning: float = field(default=0.0, init=False)
    _last: float | None = field(default=None, init=False)
    _left: float | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._lifted = np.full(len(self.contacts.feet), np.inf)  # lift-off time; inf in stance

    @property
    def angular_velocity_rms(self) -> float:
        """Root mean square of the base's angular velocity, rad/s."""
        return float(np.sqrt(self._turning / self.time)) if self.time > 0.0 else 0.0

    def update(self, observation: Observation) -> None:
        """Process the observation of a tick."""
        now, joints, base = observation.time, observation.joints, observation.base
        dt = 0.0 if self._last is None else now - self._last
        self._last = now
        self.time += dt
        self.work += dt * float(np.abs(joints.torque * joints.velocity).sum())
        if base is not None:
            self._turning += dt * float(base.angular_velocity @ base.angular_velocity)
        down = self.contacts.feet_down(observation.contacts)
        self._touch(now, down)
        self._fly(now, bool(down.any()))

    def cost_of_transport(self, mass: float, distance: float) -> float | None:
        """Return work / (weight x distance) for `mass` kg over `distance` m, or None for 0 m."""
        return self.work / (mass * GRAVITY * distance) if distance > 0.0 else None

    @property
    def skips(self) -> float:
        """Share of the touchdowns in a skipping pattern: twice on one foot, twice on the other."""
        same = [one == other for one, other in pairwise(self.touchdowns)]
        turns = [one != other for one, other in pairwise(same)]
        return float(np.mean(turns)) if turns else 0.0

    def _touch(self, now: float, down: Mask) -> None:
        for foot in np.flatnonzero(down & (now - self._lifted > SHORTEST_FLIGHT - 1e-9)):
            self.touchdowns.append(int(foot))
        self._lifted = np.where(down, np.inf, np.minimum(self._lifted, now))

    def _fly(self, now: float, down: bool) -> None:
        if not down and self._left is None:
            self._left = now
        if down and self._left is not None:
            if now - self._left > SHORTEST_FLIGHT - 1e-9:
                self.flights += 1
                self.flight_time += now - self._left
            self._left = None
