"""Control tables of Dynamixel protocol 1: AX-12A, MX-28, MX-64, MX-106, from the ROBOTIS e-Manual.

Speeds and loads are magnitudes with direction bit 10. An AX has no gains but compliance: a margin
and a slope on each side of the goal. `present_current` (MX-64, MX-106) reads 2048 at zero current,
4.5 mA per count; its address is so far from the position that the cyclic read does not include it.
"""

from math import pi

from windup.hal.errors import UnknownNameError
from windup.hal.registers import Register, RegisterTable

COUNT = 2.0 * pi / 4096
"""One count of an MX, rad."""
AX_COUNT = 300.0 * pi / 180.0 / 1024
"""One count of an AX, rad."""
SPEED = 0.114 * 2.0 * pi / 60.0
"""One speed unit of an MX, rad/s."""
AX_SPEED = 0.111 * 2.0 * pi / 60.0
"""One speed unit of an AX, rad/s."""

BAUD_CODES = {1_000_000: 1, 500_000: 3, 400_000: 4, 250_000: 7, 200_000: 9, 115_200: 16} | {
    57_600: 34,
    19_200: 103,
    9_600: 207,
}
"""Maps baud rate to its register value n, 2,000,000 / (n + 1), as listed in the e-Manual."""
FAST_CODES = {2_250_000: 250, 2_500_000: 251, 3_000_000: 252}
"""Further baud rates, of the MX only."""


def _table(count: float, speed: float) -> tuple[Register, ...]:
    """Return the registers common to AX and MX; `count` is in rad, the `speed` unit in rad/s."""
    return (
        Register("model_number", 0, 2, "eeprom", False),
        Register("firmware_version", 2, 1, "eeprom", False),
        Register("id", 3, 1, "eeprom"),
        Register("baud_rate", 4, 1, "eeprom"),
        Register("return_delay", 5, 1, "eeprom", unit=2e-6),
        Register("min_position_limit", 6, 2, "eeprom", unit=count),
        Register("max_position_limit", 8, 2, "eeprom", unit=count),
        Register("temperature_limit", 11, 1, "eeprom"),
        Register("min_voltage_limit", 12, 1, "eeprom", unit=0.1),
        Register("max_voltage_limit", 13, 1, "eeprom", unit=0.1),
        Register("max_torque", 14, 2, "eeprom", unit=1.0 / 1023),
        Register("status_return_level", 16, 1, "eeprom"),
        Register("alarm_led", 17, 1, "eeprom"),
        Register("shutdown", 18, 1, "eeprom"),
        Register("torque_enable", 24, 1),
        Register("led", 25, 1),
        Register("goal_position", 30, 2, unit=count),
        Register("goal_speed", 32, 2, unit=speed),
        Register("torque_limit", 34, 2, unit=1.0 / 1023),
        Register("present_position", 36, 2, "ram", False, unit=count),
        Register("present_velocity", 38, 2, "ram", False, unit=speed, sign_bit=10),
        Register("present_load", 40, 2, "ram", False, unit=1e-3, sign_bit=10),
        Register("present_voltage", 42, 1, "ram", False, unit=0.1),
        Register("present_temperature", 43, 1, "ram", False),
        Register("registered", 44, 1, "ram", False),
        Register("moving", 46, 1, "ram", False),
        Register("eeprom_lock", 47, 1),  # cannot be cleared before power-off: never written
        Register("punch", 48, 2),
    )


AX_ONLY = (
    Register("cw_compliance_margin", 26, 1, unit=AX_COUNT),
    Register("ccw_compliance_margin", 27, 1, unit=AX_COUNT),
    Register("compliance_slopes", 28, 2),  # clockwise slope in the low byte, other in the high one
)
MX_ONLY = (
    Register("multi_turn_offset", 20, 2, "eeprom", signed=True, unit=COUNT),
    Register("resolution_divider", 22, 1, "eeprom"),
    Register("position_d_gain", 26, 1),
    Register("position_i_gain", 27, 1),
    Register("position_p_gain", 28, 1),
    Register("realtime_tick", 50, 2, "ram", False, unit=1e-3),
    Register("goal_acceleration", 73, 1, unit=8.583 * pi / 180.0),
)
CURRENT_ONLY = (
    Register("present_current", 68, 2, "ram", False, unit=4.5e-3),
    Register("torque_mode", 70, 1),
    Register("goal_torque", 71, 2, unit=4.5e-3, sign_bit=10),
)
MX_106_ONLY = (Register("drive_mode", 10, 1, "eeprom"),)

AX = (*_table(AX_COUNT, AX_SPEED), *AX_ONLY)
MX = (*_table(COUNT, SPEED), *MX_ONLY)

# name, model number, registers
MODELS = (
    ("AX-12A", 12, AX),
    ("MX-28", 29, MX),
    ("MX-64", 310, (*MX, *CURRENT_ONLY)),
    ("MX-106", 320, (*MX, *CURRENT_ONLY, *MX_106_ONLY)),
)

COMMON = {register.name: register for register in _table(COUNT, SPEED)}
"""Registers common to all models, by name; units are those of an MX."""
NUMBERS = {number: name for name, number, _ in MODELS}

HARDWARE_ERRORS = {0: "input voltage", 2: "overheating", 5: "overload"}
"""Maps hardware error bits of the error byte to meanings; other bits concern the instruction."""

_TABLES = {name: RegisterTable(name, registers) for name, _, registers in MODELS}


def mx_registers(model: str) -> RegisterTable:
    """Return the registers of `model`.

    >>> mx_registers("MX-28")["position_p_gain"].address
    28

    Raises:
        UnknownNameError: The model is not of this family.
    """
    try:
        return _TABLES[model]
    except KeyError:
        raise UnknownNameError("Dynamixel servo of protocol 1", model, _TABLES) from None
