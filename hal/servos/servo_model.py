"""What a position servo is: a motor with a gearbox, and a P register that turns error into duty."""

from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np

RPM = 2.0 * pi / 60.0
"""One turn a minute, rad/s."""
EXTENDED_COUNTS = 1_048_575
"""Largest goal in extended position mode, counts: 256 turns (e-Manual XM430, Goal Position)."""


class OwnLimits(NamedTuple):
    """Where a servo begins to protect itself: its limit registers as they leave the factory.

    Attributes:
        temperature: It switches its torque off there, degrees C.
        low: Supply below which it signals an error, V.
        high: Supply above which it does, V.
    """

    temperature: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a data sheet, at the output shaft.

    Attributes:
        voltage: Supply, V.
        stall_torque: Torque that stops the shaft, N m.
        no_load_speed: Speed without a load, rad/s.
        stall_current: Current at stall, A; None where the sheet is silent.
    """

    voltage: float
    stall_torque: float
    no_load_speed: float
    stall_current: float | None = None

    @classmethod
    def of(cls, volt: float, stall: float, rpm: float, amp: float | None = None) -> "Row":
        """Return a row as data sheets print it: V, N m, turns a minute, A."""
        return cls(volt, stall, rpm * RPM, amp)


@dataclass(frozen=True, slots=True)
class Motor:
    """A DC motor behind its gearbox at one supply voltage: tau = (K / R) (duty V - K dq).

    Attributes:
        voltage: Supply V, V.
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
        """Resistance that makes the stall torque true, ohm. No ohmmeter shows it."""
        return self.K * self.voltage / self.stall_torque


@dataclass(frozen=True, slots=True)
class ServoModel:
    """One type of position servo. Everything is at the output shaft.

    The servo's law, from the makers' manuals::

        duty = clip(error_gain P (goal - q), -pwm_limit, pwm_limit)
        tau = (K / R) (duty V - K dq)

    so that, below saturation, a P register is a stiffness, and K^2/R is a damping that no
    register takes away.

    Attributes:
        name: As printed on the servo.
        model_number: What the servo answers to a ping.
        rows: Data sheet, rising in voltage.
        error_gain: Duty per rad of error and unit of the P register, 1/rad.
        p_default: P register as the servo leaves the factory.
        armature: Rotor inertia through the gearbox, kg m2.
        friction_loss: Dry friction, N m.
        counts_per_rev: Counts of one turn; where the encoder sees less, as many as it would have.
        pwm_limit: Largest duty.
        encoder_counts: How many counts the encoder has.
        goal_speed: Fastest that the firmware lets a goal run, rad/s.
        limits: Where it begins to protect itself, or None where nobody has published that.
    """

    name: str
    model_number: int
    rows: tuple[Row, ...]
    error_gain: float
    p_default: int
    armature: float
    friction_loss: float
    counts_per_rev: float = 4096
    pwm_limit: float = 1.0
    encoder_counts: int = 4096
    goal_speed: float = np.inf
    limits: OwnLimits | None = None

    def motor(self, voltage: float) -> Motor:
        """Return the motor at a supply of `voltage` V.

        Linear between the rows; outside them in proportion to the voltage, as for a DC motor.

        >>> from windup.hal.servos import servo_model
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
        """Return what a P register means at `voltage` V, N m/rad: error_gain P V K / R."""
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
        """The count half way."""
        return self.encoder_counts // 2

    @property
    def torque_constant(self) -> float | None:
        """Torque for each ampere of stall current, N m/A: mean of the rows that print one."""
        ratios = [row.stall_torque / row.stall_current for row in self.rows if row.stall_current]
        return float(np.mean(ratios)) if ratios else None


@dataclass(frozen=True, slots=True)
class ServoMount:
    """How one servo sits at one joint: ``counts = zero + sign ratio q counts_per_rev / (2 pi)``.

    Attributes:
        model: The type of servo.
        bus: Name of the bus that it hangs on.
        id: Its address there.
        sign: +1 or -1: does the servo turn with the joint or against it?
        zero: Counts at joint angle 0, before calibration.
        ratio: Turns of the servo for one of the joint.
        offset: What its register `homing_offset` holds, counts: it shifts what it calls `zero`.
        extended: It counts on over many turns (extended position mode), instead of one.
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
    def first_count(self) -> int:
        """The smallest count that it can be sent to."""
        return -EXTENDED_COUNTS if self.extended else 0

    @property
    def last_count(self) -> int:
        """The largest count that it can be sent to."""
        return EXTENDED_COUNTS if self.extended else self.model.last_count
