"""Dynamixel X: protocol 2, little-endian, two's complement, a watchdog."""

from windup.hal.families.dialect import Protocol2
from windup.hal.families.family import Block, Family, Mark, Want
from windup.hal.families.gain import Gain
from windup.hal.registers import Register
from windup.hal.servos.servo_model import ServoModel
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
"""Errors that have to end torque: overheating, electrical shock, overload (e-Manual, Shutdown)."""
REGISTERS = {register.name: register for register in COMMON}

# Current or load, velocity, position: one run of registers, the same in the whole family.
STATE = (
    REGISTERS["present_position"],
    REGISTERS["present_velocity"],
    Register("present_current", 126, 2, "ram", False, True),
)

WANTED = (
    Want("return_delay", 0),
    Want("drive_mode", 0),  # counts up, velocity profile, a goal does not switch torque on
    Want("operating_mode", POSITION_MODE),
    Want("secondary_id", NO_SECOND_ID),  # with one it obeys what others are told
    Want("shutdown", GUARDED, GUARDED),
    Want("pwm_limit", PWM_FULL),
    Want("min_position_limit", 0),  # a goal beyond these is ignored without a word
    Want("max_position_limit", 4095),
    Want("startup_configuration", 0),  # no torque after a brown-out
    Want("status_return_level", 2),
    Want("bus_watchdog", 0),
    Want("goal_pwm", PWM_FULL),
    Want("profile_velocity", 0),
    Want("profile_acceleration", 0),
    Want("position_i_gain", 0),
    Want("position_d_gain", 0),
    Want("feedforward_1st_gain", 0),
    Want("feedforward_2nd_gain", 0),
)
_GAIN = Gain(REGISTERS["position_p_gain"], 16383)


def _wanted(model: ServoModel) -> tuple[Want, ...]:
    return WANTED


def _gain(model: str) -> Gain:
    return _GAIN


DYNAMIXEL_X = Family(
    name="Dynamixel X",
    protocol="dynamixel2",
    dialect=Protocol2(),
    registers=REGISTERS,
    table=x_series_registers,
    numbers=NUMBERS,
    bauds=BAUD_CODES,
    state=Block(126, 10, STATE),
    health=None,
    check=Block(64, 83, STATE),
    check_alone=True,
    wanted=_wanted,
    extended=Want("operating_mode", EXTENDED_MODE),
    gain=_gain,
    alert=0x80,
    errors=HARDWARE_ERRORS,
    shutdown="shutdown",
    torque_bytes=7,
    mark=Mark("bus_watchdog", 0),
    latching=True,
    errors_in_answers=False,
    goal_wakes=False,
)
