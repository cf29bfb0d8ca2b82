"""The control loops of an X-series servo: from goal registers to commands to the shaft.

Position modes are a voltage-limited P law (see `hal.servos.servo_model`), velocity mode is a PI law
on a ramped goal, current and PWM mode command a torque and a voltage. The I, D and feed-forward
gains of the position loop have no effect: the manual's gains include an unknown sampling period.
"""

import math

from windup.hal.servos.servo_model import ServoModel
from windup.sim_twin.wire.servos.encoder import Encoder
from windup.sim_twin.wire.servos.profile import Profile
from windup.sim_twin.wire.servos.register_file import RegisterFile
from windup.sim_twin.wire.servos.x_series import (
    ACCELERATION_UNIT,
    COUNTS_PER_RAD,
    CURRENT,
    CURRENT_POSITION,
    EXTENDED,
    POSITION,
    PWM,
    PWM_FULL,
    VELOCITY,
    VELOCITY_UNIT,
    XSeriesModel,
)
from windup.sim_twin.wire.shafts.shaft import Shaft

TIME_BASED = 0x04  # bit of the drive mode
POSITION_MODES = frozenset((POSITION, EXTENDED, CURRENT_POSITION))
VELOCITY_RATE = 1000.0  # sampling rate, Hz, assumed: the manual's I gain includes its period


class ControlLoop:
    """Drives the shaft of one servo according to its registers.

    Attributes:
        registers: The control table.
        servo: Data sheet of the servo.
        shaft: The shaft that is driven.
        encoder: Conversion between counts and angle.
        supply: Voltage at the servo, V.
        constant: K of the motor at the supply that the servo was built for, V s/rad.
        resistance: R of the motor, ohm.
        mode: Operating mode.
        busy: Whether `update` must be called at every step.
    """

    def __init__(
        self,
        model: XSeriesModel,
        servo: ServoModel,
        registers: RegisterFile,
        shaft: Shaft,
        supply: float,
    ) -> None:
        self.registers, self.servo, self.shaft, self.supply = registers, servo, shaft, supply
        self.encoder = Encoder()
        motor = servo.motor(supply)
        self.constant, self.resistance = motor.K, motor.R
        self.mode = POSITION
        self.busy = False
        self.profile = Profile(0.0, 0.0, 0.0, 0.0, 0.0)
        self._since = -math.inf
        self._integral = 0.0
        unit, constant = model.current_unit, servo.torque_constant
        self.torque_unit = unit * constant if unit and constant else None  # N m per count
        self._stiffness_unit = servo.error_gain * self.constant / self.resistance

    def start_at(self, value: float) -> None:
        """Make `value` (counts, or velocity units) the goal, with the profile finished."""
        self.profile = Profile(value, 0.0, value, 0.0, 0.0)
        self._since = -math.inf
        self._integral = 0.0

    def trajectory(self, now: float) -> tuple[float, float]:
        """Return the profile's position, counts, and velocity, velocity units."""
        value, rate = self.profile.state_at(now - self._since)
        if self.mode == VELOCITY:
            return 0.0, value
        return value, rate / (VELOCITY_UNIT * COUNTS_PER_RAD)

    def in_progress(self, now: float) -> bool:
        """Return whether the profile is still in progress."""
        return now - self._since < self.profile.duration

    def plan(self, now: float) -> None:
        """Start the profile towards the goal in the registers."""
        if self.mode in POSITION_MODES:
            self._plan_position(now)
        elif self.mode == VELOCITY:
            self._plan_velocity(now)
        self._since = now

    def release(self) -> None:
        """Switch the motor off: the shaft turns freely."""
        self.busy = False
        self.shaft.release()

    def update(self, now: float, dt: float = 0.0) -> None:
        """Command the shaft for now; `dt` s have passed since the last step."""
        get, mode = self.registers.get, self.mode
        most = min(get("pwm_limit"), abs(get("goal_pwm")))
        volts = most / PWM_FULL * self.supply
        if mode in POSITION_MODES:
            self.busy = self.in_progress(now)
            self._hold(now, volts)
        elif mode == VELOCITY:
            self.busy = True
            self._regulate(now, dt, most)
        elif mode == PWM:
            self.busy = False
            self.shaft.apply_voltage(self.encoder.sign * math.copysign(volts, get("goal_pwm")))
        elif mode == CURRENT:
            self.busy = False
            self.shaft.apply_torque(self.encoder.sign * self._goal_torque(), volts)

    def _goal_torque(self) -> float:
        return (self.torque_unit or 0.0) * self.registers.get("goal_current")

    def _hold(self, now: float, volts: float) -> None:
        angle = self.encoder.angle(self.profile.state_at(now - self._since)[0])
        gain = self.registers.get("position_p_gain")
        stiffness = gain * self._stiffness_unit * self.supply
        most = abs(self._goal_torque()) if self.mode == CURRENT_POSITION else math.inf
        self.shaft.hold_goal(angle, stiffness, volts, most)

    def _regulate(self, now: float, dt: float, most: int) -> None:
        """Velocity loop: PWM = P/128 e + I/65536 sum(e), e in units of 0.229 rev/min."""
        get = self.registers.get
        sign = self.encoder.sign
        error = (
            self.profile.state_at(now - self._since)[0] - sign * self.shaft.velocity / VELOCITY_UNIT
        )
        step = get("velocity_i_gain") / 65536.0 * error * dt * VELOCITY_RATE
        pwm = get("velocity_p_gain") / 128.0 * error + self._integral + step
        if abs(pwm) < most:
            self._integral += step
        pwm = max(-most, min(most, pwm))
        self.shaft.apply_voltage(sign * pwm / PWM_FULL * self.supply)

    def _plan_position(self, now: float) -> None:
        get = self.registers.get
        goal, top, rise = get("goal_position"), get("profile_velocity"), get("profile_acceleration")
        position, velocity = self.profile.state_at(now - self._since)
        if get("drive_mode") & TIME_BASED:
            self.profile = Profile.timed(position, goal, top / 1e3, rise / 1e3)
        else:
            speed = top * VELOCITY_UNIT * COUNTS_PER_RAD
            acceleration = rise * ACCELERATION_UNIT * COUNTS_PER_RAD
            self.profile = Profile(position, velocity, goal, speed, acceleration)

    def _plan_velocity(self, now: float) -> None:
        get = self.registers.get
        present, goal, rise = (
            self.profile.state_at(now - self._since)[0],
            get("goal_velocity"),
            get("profile_acceleration"),
        )
        rate = rise * ACCELERATION_UNIT / VELOCITY_UNIT
        if get("drive_mode") & TIME_BASED and rise:
            rate = abs(goal - present) / (rise / 1e3)
        self.profile = Profile(present, 0.0, goal, rate, 0.0)
