"""The control loop of a protocol 1 servo: from goals in counts to commands to the shaft.

``duty = clip(gain (goal - angle), -most, most)``, where the goal follows a profile. The speed loop
is the same with a continuously moving goal, at most as far ahead as saturates the duty. I and D
gains, dead bands and punch are stored in registers but have no effect.
"""

import math

from windup.hal.servos.servo_model import ServoModel
from windup.sim_twin.wire.servos.profile import Profile
from windup.sim_twin.wire.shafts.shaft import Shaft


class MotorLoop:
    """Drives one shaft.

    Attributes:
        servo: The servo's data sheet.
        shaft: The shaft that is driven.
        supply: Voltage at the servo, V.
        per_rad: Counts per rad.
        centre: Counts at shaft angle 0.
        gain: Duty per rad of error.
        most: Largest duty.
        torque: Largest torque, N m.
        busy: Whether `update` must be called at every step.
        position: Angle at the last `sample`, rad.
        velocity: Speed at the last `sample`, rad/s.
        effort: Torque of the motor at the last `sample`, N m.
    """

    def __init__(
        self, servo: ServoModel, shaft: Shaft, supply: float, per_rad: float, centre: float
    ) -> None:
        self.servo, self.shaft, self.supply = servo, shaft, supply
        self.per_rad, self.centre = per_rad, centre
        motor = servo.motor(supply)
        self.constant, self.resistance = motor.K, motor.R
        self.gain, self.most, self.torque = 0.0, 1.0, math.inf
        self.busy = False
        self.position = self.velocity = self.effort = 0.0
        self._profile = Profile(0.0, 0.0, 0.0, 0.0, 0.0)
        self._since = -math.inf
        self._running: float | None = None  # angle of a continuously moving goal, rad

    def counts(self, angle: float) -> float:
        """Return the counts at `angle` rad, before rounding."""
        return self.centre + angle * self.per_rad

    def sample(self) -> None:
        """Sample position, velocity and torque of the shaft."""
        shaft = self.shaft
        self.position, self.velocity, self.effort = shaft.position, shaft.velocity, shaft.torque

    def hold_here(self) -> None:
        """Make the present position the goal, with the profile finished."""
        here = self.counts(self.shaft.position)
        self._profile = Profile(here, 0.0, here, 0.0, 0.0)
        self._since, self._running = -math.inf, None

    def goal(self, now: float) -> tuple[float, float]:
        """Return the profile's position, counts, and velocity, counts/s."""
        if self._running is not None:
            return self.counts(self._running), self._profile.state_at(now - self._since)[0]
        return self._profile.state_at(now - self._since)

    def moving(self, now: float) -> bool:
        """Return whether the profile is still in progress."""
        return now - self._since < self._profile.duration

    def move(self, now: float, goal: float, speed: float, rise: float) -> None:
        """Start a profile to `goal` counts at `speed` counts/s (0: a step) and `rise` counts/s2."""
        position, velocity = self.goal(now)
        self._profile = Profile(position, velocity if rise else 0.0, goal, speed, rise)
        self._since, self._running = now, None

    def move_in(self, now: float, goal: float, seconds: float) -> None:
        """Start a profile that reaches `goal` counts in `seconds`."""
        self._profile = Profile.timed(self.goal(now)[0], goal, seconds, 0.0)
        self._since, self._running = now, None

    def run(self, now: float, speed: float, rise: float) -> None:
        """Let the goal move on at `speed` counts/s, reached at `rise` counts/s2 (0: at once)."""
        present = self.goal(now)[1]
        if self._running is None:
            self._running = self.shaft.position
        self._profile = Profile(present, 0.0, speed, rise, 0.0)
        self._since = now

    def apply_duty(self, duty: float) -> None:
        """Apply a share of the supply voltage to the motor, regardless of the position."""
        self.busy = False
        self.shaft.apply_voltage(max(-self.most, min(self.most, duty)) * self.supply)

    def release(self) -> None:
        """Switch the motor off: the shaft turns freely."""
        self.busy, self._running = False, None
        self.shaft.release()

    def update(self, now: float, dt: float = 0.0) -> None:
        """Command the shaft for now; `dt` s have passed since the last step."""
        if self._running is not None:
            self._run_on(now, dt)
            target = self._running
        else:
            target = (self._profile.state_at(now - self._since)[0] - self.centre) / self.per_rad
        self.busy = self._running is not None or self.moving(now)
        stiffness = self.gain * self.supply * self.constant / self.resistance
        self.shaft.hold_goal(target, stiffness, self.most * self.supply, self.torque)

    def duty(self) -> float:
        """Return the duty that yields the last sample's torque at its speed."""
        if self.supply <= 0.0:
            return 0.0
        volts = self.effort * self.resistance / self.constant + self.constant * self.velocity
        return max(-1.0, min(1.0, volts / self.supply))

    def amperes(self) -> float:
        """Return the current of the last sample, A; negative against the counts."""
        return self.effort / (self.servo.torque_constant or self.constant * TORQUE_SHARE)

    def relative_torque(self) -> float:
        """Return the last sample's torque as a share of the present stall torque."""
        stall = self.constant / self.resistance * self.supply
        return abs(self.effort) / stall if stall > 0.0 else 0.0

    def _run_on(self, now: float, dt: float) -> None:
        """Advance a continuously moving goal by `dt` s."""
        angle = self.shaft.position
        lead = self.most / self.gain if self.gain > 0.0 else 0.0
        speed = self._profile.state_at(now - self._since)[0] / self.per_rad
        ahead = (self._running or 0.0) + speed * dt
        self._running = max(angle - lead, min(angle + lead, ahead))


TORQUE_SHARE = 0.43
"""Torque constant over K where no data sheet states a stall current: the 12 V STS3215's."""
