"""Control tables of ROBOTIS Dynamixel X: common registers, and those that differ between models.

Addresses, units and model numbers are those of the ROBOTIS e-Manual. Register 126 differs in
meaning: present current in 2.69 mA (XM, XH: motor phase) or 1 mA (XC330, XL330: supply side),
but present LOAD in 0.1 % on XL430, 2XL430, XC430 and 2XC430, which do not measure current.
"""

from math import pi

from windup.hal.errors import UnknownNameError
from windup.hal.registers import Register, RegisterTable

COUNT = 2.0 * pi / 4096
"""One encoder count, rad."""
RPM = 0.229 * 2.0 * pi / 60.0
"""One unit of velocity, rad/s."""
PWM = 1.0 / 885.0
"""One unit of PWM, as a duty."""
RAMP = 214.577 * 2.0 * pi / 3600.0
"""One unit of profile acceleration, rad/s2."""

# name, address, size, area, writable, signed, SI value of one count
COMMON = (
    Register("model_number", 0, 2, "eeprom", False),
    Register("model_information", 2, 4, "eeprom", False),
    Register("firmware_version", 6, 1, "eeprom", False),
    Register("id", 7, 1, "eeprom"),
    Register("baud_rate", 8, 1, "eeprom"),
    Register("return_delay", 9, 1, "eeprom", unit=2e-6),
    Register("drive_mode", 10, 1, "eeprom"),
    Register("operating_mode", 11, 1, "eeprom"),
    Register("secondary_id", 12, 1, "eeprom"),
    Register("protocol_type", 13, 1, "eeprom"),
    Register("homing_offset", 20, 4, "eeprom", signed=True, unit=COUNT),
    Register("moving_threshold", 24, 4, "eeprom", unit=RPM),
    Register("temperature_limit", 31, 1, "eeprom"),
    Register("max_voltage_limit", 32, 2, "eeprom", unit=0.1),
    Register("min_voltage_limit", 34, 2, "eeprom", unit=0.1),
    Register("pwm_limit", 36, 2, "eeprom", unit=PWM),
    Register("velocity_limit", 44, 4, "eeprom", unit=RPM),
    Register("max_position_limit", 48, 4, "eeprom", unit=COUNT),
    Register("min_position_limit", 52, 4, "eeprom", unit=COUNT),
    Register("shutdown", 63, 1, "eeprom"),
    Register("torque_enable", 64, 1),
    Register("led", 65, 1),
    Register("status_return_level", 68, 1),
    Register("registered_instruction", 69, 1, "ram", False),
    Register("hardware_error", 70, 1, "ram", False),
    Register("velocity_i_gain", 76, 2),
    Register("velocity_p_gain", 78, 2),
    Register("position_d_gain", 80, 2),
    Register("position_i_gain", 82, 2),
    Register("position_p_gain", 84, 2),
    Register("feedforward_2nd_gain", 88, 2),
    Register("feedforward_1st_gain", 90, 2),
    Register("bus_watchdog", 98, 1, signed=True, unit=0.02),
    Register("goal_pwm", 100, 2, signed=True, unit=PWM),
    Register("goal_velocity", 104, 4, signed=True, unit=RPM),
    Register("profile_acceleration", 108, 4, unit=RAMP),
    Register("profile_velocity", 112, 4, unit=RPM),
    Register("goal_position", 116, 4, signed=True, unit=COUNT),
    Register("realtime_tick", 120, 2, "ram", False, unit=1e-3),
    Register("moving", 122, 1, "ram", False),
    Register("moving_status", 123, 1, "ram", False),
    Register("present_pwm", 124, 2, "ram", False, True, PWM),
    Register("present_velocity", 128, 4, "ram", False, True, RPM),
    Register("present_position", 132, 4, "ram", False, True, COUNT),
    Register("velocity_trajectory", 136, 4, "ram", False, True, RPM),
    Register("position_trajectory", 140, 4, "ram", False, True, COUNT),
    Register("present_voltage", 144, 2, "ram", False, unit=0.1),
    Register("present_temperature", 146, 1, "ram", False),
)

LOAD = (Register("present_load", 126, 2, "ram", False, True, 1e-3),)
STARTUP = (Register("startup_configuration", 60, 1, "eeprom"),)
PWM_SLOPE = (Register("pwm_slope", 62, 1, "eeprom"),)
EXTERNAL_PORTS = tuple(
    register
    for port in range(3)
    for register in (
        Register(f"external_port_mode_{port + 1}", 56 + port, 1, "eeprom"),
        Register(f"external_port_data_{port + 1}", 152 + 2 * port, 2),
    )
)


def _current(unit: float) -> tuple[Register, ...]:
    """Return the current registers of a model that measures current; `unit` is A per count."""
    return (
        Register("current_limit", 38, 2, "eeprom", unit=unit),
        Register("goal_current", 102, 2, signed=True, unit=unit),
        Register("present_current", 126, 2, "ram", False, True, unit),
    )


PHASE = _current(2.69e-3)
SUPPLY = _current(1.0e-3)

# name, model number, registers in addition to the common ones
MODELS = (
    ("XH430-W350", 1000, PHASE),
    ("XH430-W210", 1010, PHASE),
    ("XM430-W350", 1020, (*PHASE, *STARTUP)),
    ("XM430-W210", 1030, (*PHASE, *STARTUP)),
    ("XH430-V350", 1040, PHASE),
    ("XH430-V210", 1050, PHASE),
    ("XL430-W250", 1060, (*LOAD, *STARTUP)),
    ("XC430-W150", 1070, (*LOAD, *STARTUP)),
    ("XC430-W240", 1080, (*LOAD, *STARTUP)),
    ("2XL430-W250", 1090, LOAD),
    ("XH540-W270", 1100, (*PHASE, *STARTUP, *EXTERNAL_PORTS)),
    ("XH540-W150", 1110, (*PHASE, *STARTUP, *EXTERNAL_PORTS)),
    ("XM540-W270", 1120, (*PHASE, *STARTUP, *EXTERNAL_PORTS)),
    ("XM540-W150", 1130, (*PHASE, *STARTUP, *EXTERNAL_PORTS)),
    ("XH540-V270", 1140, (*PHASE, *STARTUP, *EXTERNAL_PORTS)),
    ("XH540-V150", 1150, (*PHASE, *STARTUP, *EXTERNAL_PORTS)),
    ("2XC430-W250", 1160, LOAD),
    ("XL330-M077", 1190, (*SUPPLY, *STARTUP, *PWM_SLOPE)),
    ("XL330-M288", 1200, (*SUPPLY, *STARTUP, *PWM_SLOPE)),
    ("XC330-T181", 1210, (*SUPPLY, *STARTUP, *PWM_SLOPE)),
    ("XC330-T288", 1220, (*SUPPLY, *STARTUP, *PWM_SLOPE)),
    ("XC330-M181", 1230, (*SUPPLY, *STARTUP, *PWM_SLOPE)),
    ("XC330-M288", 1240, (*SUPPLY, *STARTUP, *PWM_SLOPE)),
)

BAUD_CODES = {
    9_600: 0,
    57_600: 1,
    115_200: 2,
    1_000_000: 3,
    2_000_000: 4,
    3_000_000: 5,
    4_000_000: 6,
    4_500_000: 7,
}
"""Maps baud rate to its register value; XC330 and XL330 support values up to 6."""

HARDWARE_ERRORS = {
    0: "input voltage",
    2: "overheating",
    3: "encoder",
    4: "electrical shock",
    5: "overload",
}
"""Maps each bit of `hardware_error` to its meaning."""

_TABLES = {name: RegisterTable(name, (*COMMON, *extra)) for name, _, extra in MODELS}
NUMBERS = {number: name for name, number, _ in MODELS}


def x_series_registers(model: str) -> RegisterTable:
    """Return the registers of `model`.

    >>> x_series_registers("XL430-W250")["present_load"].unit
    0.001

    Raises:
        UnknownNameError: The model is not of this family.
    """
    try:
        return _TABLES[model]
    except KeyError:
        raise UnknownNameError("X series servo", model, _TABLES) from None
