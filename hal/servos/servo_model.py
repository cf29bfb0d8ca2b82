"""Model of a position servo: DC motor, gearbox, and a P register from position error to duty."""

from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np

RPM = 2.0 * pi / 60.0
"""One revolution per minute, rad/s."""
EXTENDED_COUNTS = 1_048_575
"""Largest goal in extended position mode, counts: 256 turns (e-Manual XM430, Goal Position)."""


class ProtectionLimits(NamedTuple):
    """Limits at which a servo protects itself: factory defaults of its limit registers.

    Attributes:
        temperature: Temperature at which it switches its torque off, degrees C.
        low: Supply voltage below which it signals an error, V.
        high: Supply voltage above which it signals an error, V.
    """

    temperature: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class DatasheetRow:
    """One row of a data sheet, at the output shaft.

    Attributes:
        voltage: Supply voltage, V.
        stall_torque: Stall torque, N m.
        no_load_speed: Speed without load, rad/s.
        stall_current: Current at stall, A; None if the data sheet does not state it.
    """

    voltage: float
    stall_torque: float
    no_load_speed: float
    stall_current: float | None = None

    @classmethod
    def of(cls, volt: float, stall: float, rpm: float, amp: float | None = None) -> "DatasheetRow":
        """Return a row from data sheet units: V, N m, rpm, A."""
        return cls(volt, stall, rpm * RPM, amp)


@dataclass(frozen=True, slots=True)
class Motor:
    """A DC motor behind its gearbox at one supply voltage: tau = (K / R) (duty V - K dq).

    Attributes:
        voltage: Supply voltage V, V.
        stall_torque: K V / R, N m.
        no_load_speed: V / K, rad/s.
    """

    voltage: float
    stall_torque: float
    no_load_speed: float

    @property
    def K(self) -> float:  # noqa: N802 - the literature's symbol
        """Back-EMF (and torque) constant, V s/rad."""
        return self.voltage / self.no_load_speed

    @property
    def R(self) -> float:  # noqa: N802 - the literature's symbol
        """Effective resistance that yields the stall torque, ohm; not the winding resistance."""
        return self.K * self.voltage / self.stall_torque


@dataclass(frozen=True, slots=True)
class ServoModel:
    """One model of position servo. All quantities are at the output shaft.

    The control law, from the makers' manuals::

        duty = clip(error_gain P (goal - q), -pwm_limit, pwm_limit)
        tau = (K / R) (duty V - K dq)

    so that, below saturation, a P register is a stiffness, and K^2/R is a damping that no
    register can reduce.

    Attributes:
        name: Name printed on the servo.
        model_number: Value of its model number register.
        rows: Data sheet, in order of rising voltage.
        error_gain: Duty per rad of error and unit of the P register, 1/rad.
        p_default: Factory default of the P register.
        armature: Rotor inertia reflected through the gearbox, kg m2.
        friction_loss: Dry friction, N m.
        counts_per_rev: Counts per turn; extrapolated if the encoder covers less than a turn.
        pwm_limit: Maximum duty.
        encoder_counts: Number of counts of the encoder.
        goal_speed: Maximum speed at which the firmware moves its internal goal, rad/s.
        limits: Limits at which it protects itself, or None if they are not published.
    """

    name: str
    model_number: int
    rows: tuple[DatasheetRow, ...]
    error_gain: float
    p_default: int
    armature: float
    friction_loss: float
    counts_per_rev: float = 4096
    pwm_limit: float = 1.0
    encoder_counts: int = 4096
    goal_speed: float = np.inf
    limits: ProtectionLimits | None = None

    def motor(self, voltage: float) -> Motor:
        """Return the motor at a supply of `voltage` V.

        Values are interpolated between the rows, and proportional to voltage outside them.

        >>> from windup.hal.families import servo_model
        >>> round(servo_model("XM430-W350").motor(12.0).R, 3)
        7.291
        """
        volts = [row.voltage for row in self.rows]
        nearest = min(max(voltage, volts[0]), volts[-1])
        scale = voltage / nearest
        stall = float(np.interp(nearest, volts, [row.stall_torque for row in self.rows]))
        speed = float(np.interp(nearest, volts, [row.no_load_speed for row in self.rows]))
        return Motor(voltage, scale * stall, scale * speed)

    def stiffness(self, p_register: float, voltage: float) -> float:
        """Return the stiffness of a P register at `voltage` V, N m/rad: error_gain P V K / R."""
        return self.error_gain * p_register * self.motor(voltage).stall_torque

    def p_register(self, stiffness: float, voltage: float) -> float:
        """Return the P register (not rounded) for `stiffness` N m/rad at `voltage` V."""
        return stiffness / (self.error_gain * self.motor(voltage).stall_torque)

    def damping(self, voltage: float) -> float:
        """Return the damping K^2/R of the motor itself at `voltage` V, N m s/rad."""
        motor = self.motor(voltage)
        return motor.stall_torque / motor.no_load_speed

    @property
    def last_count(self) -> int:
        """The largest count of the encoder."""
        return self.encoder_counts - 1

    @property
    def middle(self) -> int:
        """The middle count of the encoder."""
        return self.encoder_counts // 2

    @property
    def torque_constant(self) -> float | None:
        """Stall torque per stall current, N m/A, mean over the rows; None without currents."""
        ratios = [row.stall_torque / row.stall_current for row in self.rows if row.stall_current]
        return float(np.mean(ratios)) if ratios else None


@dataclass(frozen=True, slots=True)
class ServoMount:
    """Mounting of a servo at a joint: ``counts = zero + sign ratio q counts_per_rev / (2 pi)``.

    Attributes:
        model: The servo model.
        bus: Name of its bus.
        id: Its id on the bus.
        sign: +1 if the servo turns with the joint, -1 if against it.
        zero: Counts at joint angle 0, before calibration.
        ratio: Turns of the servo per turn of the joint.
        offset: Value of its register `homing_offset` for which `zero` is valid, counts.
        extended: Whether it runs in extended (multi-turn) position mode.
    """

    model: ServoModel
    bus: str
    id: int
    sign: int
    zero: int
    ratio: float
    offset: int = 0
    extended: bool = False

    @property
    def counts_per_rad(self) -> float:
        """Counts per rad of the joint, signed."""
        return self.sign * self.ratio * self.model.counts_per_rev / (2.0 * pi)

    @property
    def first_count(self) -> int:
        """Smallest goal position, counts."""
        return -EXTENDED_COUNTS if self.extended else 0

    @property
    def last_count(self) -> int:
        """Largest goal position, counts."""
        return EXTENDED_COUNTS if self.extended else self.model.last_count
