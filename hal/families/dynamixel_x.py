"""Dynamixel X: protocol 2, little-endian, two's complement, with a Bus Watchdog."""

from windup.hal.families.family import Block, Family, RequiredSetting, RestartMark
from windup.hal.families.gain import Gain
from windup.hal.families.servo_protocol import Protocol2
from windup.hal.registers import Register
from windup.hal.servos.servo_model import ServoModel
from windup.hal.servos.x_series import X_SERIES
from windup.hal.servos.x_series_registers import (
    BAUD_CODES,
    COMMON,
    HARDWARE_ERRORS,
    NUMBERS,
    x_series_registers,
)

POSITION_MODE = 3
EXTENDED_MODE = 4
PWM_FULL = 885
NO_SECOND_ID = 255
GUARDED = 0x34
"""Shutdown bits required: overheating, electrical shock, overload (e-Manual, Shutdown)."""
REGISTERS = {register.name: register for register in COMMON}

# Current or load, velocity, position: consecutive registers, the same in the whole family.
STATE = (
    REGISTERS["present_position"],
    REGISTERS["present_velocity"],
    Register("present_current", 126, 2, "ram", False, True),
)

REQUIRED = (
    RequiredSetting("return_delay", 0),
    RequiredSetting(
        "drive_mode", 0
    ),  # normal direction, velocity-based profile, a goal does not switch torque on
    RequiredSetting("operating_mode", POSITION_MODE),
    RequiredSetting("secondary_id", NO_SECOND_ID),  # with one it obeys commands to other servos
    RequiredSetting("shutdown", GUARDED, GUARDED),
    RequiredSetting("pwm_limit", PWM_FULL),
    RequiredSetting("min_position_limit", 0),  # goals beyond these are ignored
    RequiredSetting("max_position_limit", 4095),
    RequiredSetting("startup_configuration", 0),  # no torque after a brown-out
    RequiredSetting("status_return_level", 2),
    RequiredSetting("bus_watchdog", 0),
    RequiredSetting("goal_pwm", PWM_FULL),
    RequiredSetting("profile_velocity", 0),
    RequiredSetting("profile_acceleration", 0),
    RequiredSetting("position_i_gain", 0),
    RequiredSetting("position_d_gain", 0),
    RequiredSetting("feedforward_1st_gain", 0),
    RequiredSetting("feedforward_2nd_gain", 0),
)
_GAIN = Gain(REGISTERS["position_p_gain"], 16383)


def _required(model: ServoModel) -> tuple[RequiredSetting, ...]:
    return REQUIRED


def _gain(model: str) -> Gain:
    return _GAIN


DYNAMIXEL_X = Family(
    name="Dynamixel X",
    protocol_name="dynamixel2",
    protocol=Protocol2(),
    registers=REGISTERS,
    table=x_series_registers,
    numbers=NUMBERS,
    models=X_SERIES,
    bauds=BAUD_CODES,
    state=Block(126, 10, STATE),
    health=None,
    check=Block(64, 83, STATE),
    check_alone=True,
    required=_required,
    extended=RequiredSetting("operating_mode", EXTENDED_MODE),
    gain=_gain,
    alert=0x80,
    errors=HARDWARE_ERRORS,
    shutdown="shutdown",
    torque_bytes=7,
    restart_mark=RestartMark("bus_watchdog", 0),
    latching=True,
    errors_in_answers=False,
    goal_enables_torque=False,
)
