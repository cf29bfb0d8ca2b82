"""Control tables of Feetech: STS and SMS (magnetic encoder), SCS (potentiometer).

Addresses and sign encodings are from Feetech's memory tables and its SCServo library. STS is
little-endian and encodes negative numbers as sign and magnitude, with a sign bit that differs
between registers; SCS is big-endian, and its positions are unsigned.

Register 18, phase ("special function"): bit 2 set selects a speed unit of one step per second
(0.0146 rpm; the factory default is phase 12), clear 50 steps per second (0.732 rpm); bit 4 set
makes the position count whole turns. The codes of baud rates of 57,600 and less differ between
Feetech's own SDK and LeRobot: only those on which both agree are listed.
"""

from dataclasses import replace
from math import pi

from windup.hal.errors import UnknownNameError
from windup.hal.registers import Register, RegisterTable

COUNT = 2.0 * pi / 4096
"""One count of an STS, rad."""
SCS_COUNT = 300.0 * pi / 180.0 / 1024
"""One count of an SCS, rad."""
CURRENT = 6.5e-3
"""One unit of current, A."""

STEP_SPEED, MULTI_TURN = 1 << 2, 1 << 4
"""Bits of the register `phase`."""
MIDDLE = 128
"""Value of `torque_enable` that sets `homing_offset` so that the present position reads 2048."""

BAUD_CODES = {1_000_000: 0, 500_000: 1, 250_000: 2, 128_000: 3, 115_200: 4}
"""Maps baud rate to the value of the register `baud_rate`."""

# name, address, size, area, writable, signed, SI value of one count, sign bit
COMMON = (
    Register("firmware_version", 0, 1, "eeprom", False),
    Register("firmware_minor", 1, 1, "eeprom", False),
    Register("model_number", 3, 2, "eeprom", False),
    Register("id", 5, 1, "eeprom"),
    Register("baud_rate", 6, 1, "eeprom"),
    Register("return_delay", 7, 1, "eeprom", unit=2e-6),
    Register("status_return_level", 8, 1, "eeprom"),
    Register("min_position_limit", 9, 2, "eeprom", unit=COUNT),
    Register("max_position_limit", 11, 2, "eeprom", unit=COUNT),
    Register("temperature_limit", 13, 1, "eeprom"),
    Register("max_voltage_limit", 14, 1, "eeprom", unit=0.1),
    Register("min_voltage_limit", 15, 1, "eeprom", unit=0.1),
    Register("max_torque", 16, 2, "eeprom", unit=1e-3),
    Register("phase", 18, 1, "eeprom"),
    Register("unloading_condition", 19, 1, "eeprom"),
    Register("led_alarm", 20, 1, "eeprom"),
    Register("position_p_gain", 21, 1, "eeprom"),
    Register("position_d_gain", 22, 1, "eeprom"),
    Register("position_i_gain", 23, 1, "eeprom"),
    Register("min_startup_force", 24, 2, "eeprom", unit=1e-3),
    Register("cw_dead_zone", 26, 1, "eeprom", unit=COUNT),
    Register("ccw_dead_zone", 27, 1, "eeprom", unit=COUNT),
    Register("torque_enable", 40, 1),
    Register("acceleration", 41, 1, unit=100.0 * COUNT),
    Register("goal_position", 42, 2, unit=COUNT, sign_bit=15),
    Register("goal_time", 44, 2),
    Register("goal_speed", 46, 2, unit=COUNT, sign_bit=15),
    Register("present_position", 56, 2, "ram", False, unit=COUNT, sign_bit=15),
    Register("present_velocity", 58, 2, "ram", False, unit=COUNT, sign_bit=15),
    Register("present_load", 60, 2, "ram", False, unit=1e-3, sign_bit=10),
    Register("present_voltage", 62, 1, "ram", False, unit=0.1),
    Register("present_temperature", 63, 1, "ram", False),
    Register("hardware_error", 65, 1, "ram", False),
    Register("moving", 66, 1, "ram", False),
)

STS_ONLY = (
    Register("protection_current", 28, 2, "eeprom", unit=CURRENT),
    Register("angular_resolution", 30, 1, "eeprom"),
    Register("homing_offset", 31, 2, "eeprom", unit=COUNT, sign_bit=11),
    Register("operating_mode", 33, 1, "eeprom"),
    Register("protective_torque", 34, 1, "eeprom", unit=1e-2),
    Register("protection_time", 35, 1, "eeprom", unit=1e-2),
    Register("overload_torque", 36, 1, "eeprom", unit=1e-2),
    Register("velocity_p_gain", 37, 1, "eeprom"),
    Register("overcurrent_time", 38, 1, "eeprom", unit=1e-2),
    Register("velocity_i_gain", 39, 1, "eeprom"),
    Register("torque_limit", 48, 2, unit=1e-3),
    Register("lock", 55, 1),
    Register("present_current", 69, 2, "ram", False, unit=CURRENT, sign_bit=15),
    Register("max_acceleration", 85, 1, "eeprom", unit=100.0 * COUNT),
)

SCS_ONLY = (
    Register("protective_torque", 37, 1, "eeprom", unit=1e-2),
    Register("protection_time", 38, 1, "eeprom", unit=1e-2),
    Register("lock", 48, 1),
)

NO_SIGN = ("goal_position", "goal_speed", "present_position")


def _scs(register: Register) -> Register:
    """Return the SCS version of a register: big-endian, coarser unit, unsigned positions."""
    unit = register.unit * SCS_COUNT / COUNT if register.unit in (COUNT, 100.0 * COUNT) else None
    return replace(
        register,
        order="big",
        unit=register.unit if unit is None else unit,
        sign_bit=None if register.name in NO_SIGN else register.sign_bit,
    )


STS = {register.name: register for register in (*COMMON, *STS_ONLY)}
SCS = {register.name: _scs(register) for register in (*COMMON, *SCS_ONLY)}

STS_NUMBERS = {777: "STS3215", 2825: "STS3250", 11272: "SM8512BL"}
SCS_NUMBERS = {1284: "SCS0009"}

HARDWARE_ERRORS = {
    0: "input voltage",
    1: "encoder",
    2: "overheating",
    3: "overcurrent",
    5: "overload",
}
"""Maps each bit of the error byte of status packets, and of `hardware_error`, to its meaning."""

_TABLES = {
    **{name: RegisterTable(name, STS.values()) for name in STS_NUMBERS.values()},
    **{name: RegisterTable(name, SCS.values()) for name in SCS_NUMBERS.values()},
}


def feetech_registers(model: str) -> RegisterTable:
    """Return the registers of `model`; a suffix after a dash (the winding) is ignored.

    >>> [feetech_registers(name)["lock"].address for name in ("STS3215-7.4V", "SCS0009")]
    [55, 48]

    Raises:
        UnknownNameError: The model is not of this family.
    """
    try:
        return _TABLES[model.split("-")[0]]
    except KeyError:
        raise UnknownNameError("Feetech servo", model, _TABLES) from None
