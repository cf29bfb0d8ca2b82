"""The shaft at a servo's horn, which its firmware drives."""

import math
from typing import Protocol

from windup.hal.servos.servo_model import Motor


class Shaft(Protocol):
    """The output shaft of one servo, with its motor; angle 0 is the middle of the encoder.

    The firmware maps its registers to the four ways of driving and never simulates a motor itself,
    so that the twin and the emulated bus share one servo law.
    """

    @property
    def position(self) -> float:
        """Angle, rad."""
        ...

    @property
    def velocity(self) -> float:
        """Speed, rad/s."""
        ...

    @property
    def torque(self) -> float:
        """Torque of the motor at the horn, N m."""
        ...

    def hold_goal(
        self, goal: float, stiffness: float, volts: float, torque: float = math.inf
    ) -> None:
        """Hold `goal` rad by ``u = clip(stiffness R/K (goal - q), +-volts)``, within `torque` N m.

        The stiffness, N m/rad, is that before the effect of back-EMF.
        """
        ...

    def apply_voltage(self, volts: float) -> None:
        """Apply `volts` V to the motor."""
        ...

    def apply_torque(self, torque: float, volts: float) -> None:
        """Produce `torque` N m, as far as `volts` V suffice."""
        ...

    def release(self) -> None:
        """Switch the motor off: no current flows."""
        ...


class InertiaShaft:
    """A shaft whose only load is its inertia and the friction of the gearbox.

    ``J dw/dt = K/R (u - K w) - friction sign(w) + load``, integrated implicitly in the back-EMF.

    Attributes:
        position: Angle, rad.
        velocity: Speed, rad/s.
        torque: Torque of the motor, N m.
        constant: K of the motor, V s/rad.
        resistance: R of the motor, ohm.
        load: External torque, N m.
        blocked: Whether the shaft is held still.
    """

    def __init__(self, motor: Motor, inertia: float, friction: float = 0.0) -> None:
        self.inertia, self.friction = inertia, friction
        self.constant, self.resistance = motor.K, motor.R
        self.position = self.velocity = self.torque = self.load = 0.0
        self.blocked = False
        self._mode = "off"
        self._goal = self._gain = self._volts = 0.0
        self._most = math.inf

    def hold_goal(
        self, goal: float, stiffness: float, volts: float, torque: float = math.inf
    ) -> None:
        """See `Shaft`."""
        self._mode, self._goal, self._gain, self._volts = "drive", goal, stiffness, volts
        self._most = torque

    def apply_voltage(self, volts: float) -> None:
        """See `Shaft`."""
        self._mode, self._volts, self._most = "push", volts, math.inf

    def apply_torque(self, torque: float, volts: float) -> None:
        """See `Shaft`."""
        self._mode, self._gain, self._volts, self._most = "pull", torque, volts, math.inf

    def release(self) -> None:
        """See `Shaft`."""
        self._mode = "off"

    def turn(self, angle: float, rate: float) -> None:
        """Set the shaft to `angle` rad and `rate` rad/s, as turned by hand."""
        self.position, self.velocity = angle, rate

    def step(self, dt: float) -> None:
        """Advance the simulation by `dt` s."""
        if self._mode == "off":
            stall = damping = 0.0
            if self.velocity == 0.0 and abs(self.load) <= self.friction:
                self.torque = 0.0
                return
        else:
            gain = self.constant / self.resistance
            stall, damping = self._volts_now() * gain, self.constant * gain
            if abs(stall - damping * self.velocity) > self._most:
                stall, damping = math.copysign(self._most, stall - damping * self.velocity), 0.0
        free = self.inertia * self.velocity + dt * (stall + self.load)
        drag = min(dt * self.friction, abs(free))
        free -= drag if free > 0.0 else -drag
        self.velocity = 0.0 if self.blocked else free / (self.inertia + dt * damping)
        self.position += dt * self.velocity
        self.torque = stall - damping * self.velocity

    def _volts_now(self) -> float:
        """Return the voltage at the motor, V."""
        if self._mode == "push":
            return self._volts
        if self._mode == "drive":
            volts = self._gain * self.resistance / self.constant * (self._goal - self.position)
        else:
            volts = self._gain * self.resistance / self.constant + self.constant * self.velocity
        return max(-self._volts, min(self._volts, volts))
