"""Control tables of the Dynamixel X series: one line per register, one record per model.

From the e-Manual of each model (emanual.robotis.com/docs/en/dxl/x/).
"""

import math
from dataclasses import dataclass, field
from typing import Final

from windup.hal.errors import UnknownNameError
from windup.sim_twin.wire.servos.register_file import IndirectAddresses, RegisterFile, TableItem

COUNTS: Final = 4096  # per turn
CENTRE: Final = 2048  # counts at horn angle 0
COUNTS_PER_RAD: Final = COUNTS / (2.0 * math.pi)
VELOCITY_UNIT: Final = 0.229 * 2.0 * math.pi / 60.0  # rad/s
ACCELERATION_UNIT: Final = 214.577 * 2.0 * math.pi / 3600.0  # rad/s2 (rev/min2)
PWM_FULL: Final = 885  # PWM units of the whole supply voltage
WATCHDOG_UNIT: Final = 0.020  # s

BAUD_RATES: Final = (9600, 57600, 115200, 1_000_000, 2_000_000, 3_000_000, 4_000_000, 4_500_000)

CURRENT, VELOCITY, POSITION, EXTENDED, CURRENT_POSITION, PWM = 0, 1, 3, 4, 5, 16
SIX_MODES = (CURRENT, VELOCITY, POSITION, EXTENDED, CURRENT_POSITION, PWM)
FOUR_MODES = (VELOCITY, POSITION, EXTENDED, PWM)

TURNS_256 = 1_048_575
OFFSET = 1_044_479
INT16, INT32 = -(2**15), -(2**31)

REGISTERS: Final = (
    TableItem(0, 2, "model_number"),
    TableItem(2, 4, "model_information"),
    TableItem(6, 1, "firmware_version"),
    TableItem(7, 1, "id", "RW", 1, 0, 252),
    TableItem(8, 1, "baud_rate", "RW", 1, 0, 7),
    TableItem(9, 1, "return_delay_time", "RW", 250, 0, 254),
    TableItem(10, 1, "drive_mode", "RW", 0, 0, 13),
    TableItem(11, 1, "operating_mode", "RW", 3, 0, 16),
    TableItem(12, 1, "secondary_id", "RW", 255, 0, 255),
    TableItem(13, 1, "protocol_type", "RW", 2, 1, 2),
    TableItem(20, 4, "homing_offset", "RW", 0, -OFFSET, OFFSET),
    TableItem(24, 4, "moving_threshold", "RW", 10, 0, 1023),
    TableItem(31, 1, "temperature_limit", "RW", 80, 0, 100),
    TableItem(32, 2, "max_voltage_limit", "RW", 160, 95, 160),
    TableItem(34, 2, "min_voltage_limit", "RW", 95, 95, 160),
    TableItem(36, 2, "pwm_limit", "RW", PWM_FULL, 0, PWM_FULL),
    TableItem(38, 2, "current_limit", "RW", 1193, 0, 1193),
    TableItem(44, 4, "velocity_limit", "RW", 200, 0, 1023),
    TableItem(48, 4, "max_position_limit", "RW", 4095, 0, 4095),
    TableItem(52, 4, "min_position_limit", "RW", 0, 0, 4095),
    TableItem(56, 1, "external_port_mode_1", "RW", 3, 0, 3),
    TableItem(57, 1, "external_port_mode_2", "RW", 3, 0, 3),
    TableItem(58, 1, "external_port_mode_3", "RW", 3, 0, 3),
    TableItem(60, 1, "startup_configuration", "RW", 0, 0, 3),
    TableItem(62, 1, "pwm_slope", "RW", 140, 1, 255),
    TableItem(63, 1, "shutdown", "RW", 52, 0, 63),
    TableItem(64, 1, "torque_enable", "RW", 0, 0, 1),
    TableItem(65, 1, "led", "RW", 0, 0, 1),
    TableItem(68, 1, "status_return_level", "RW", 2, 0, 2),
    TableItem(69, 1, "registered_instruction"),
    TableItem(70, 1, "hardware_error_status"),
    TableItem(76, 2, "velocity_i_gain", "RW", 1920, 0, 16383),
    TableItem(78, 2, "velocity_p_gain", "RW", 100, 0, 16383),
    TableItem(80, 2, "position_d_gain", "RW", 0, 0, 16383),
    TableItem(82, 2, "position_i_gain", "RW", 0, 0, 16383),
    TableItem(84, 2, "position_p_gain", "RW", 800, 0, 16383),
    TableItem(88, 2, "feedforward_2nd_gain", "RW", 0, 0, 16383),
    TableItem(90, 2, "feedforward_1st_gain", "RW", 0, 0, 16383),
    TableItem(98, 1, "bus_watchdog", "RW", 0, -1, 127),
    TableItem(100, 2, "goal_pwm", "RW", PWM_FULL, -PWM_FULL, PWM_FULL),
    TableItem(102, 2, "goal_current", "RW", 0, INT16, 32767),
    TableItem(104, 4, "goal_velocity", "RW", 0, INT32, 2**31 - 1),
    TableItem(108, 4, "profile_acceleration", "RW", 0, 0, 32767),
    TableItem(112, 4, "profile_velocity", "RW", 0, 0, 32767),
    TableItem(116, 4, "goal_position", "RW", 0, -TURNS_256, TURNS_256),
    TableItem(120, 2, "realtime_tick"),
    TableItem(122, 1, "moving"),
    TableItem(123, 1, "moving_status"),
    TableItem(124, 2, "present_pwm", low=INT16),
    TableItem(126, 2, "present_current", low=INT16),
    TableItem(128, 4, "present_velocity", low=INT32),
    TableItem(132, 4, "present_position", low=INT32),
    TableItem(136, 4, "velocity_trajectory", low=INT32),
    TableItem(140, 4, "position_trajectory", low=INT32),
    TableItem(144, 2, "present_input_voltage"),
    TableItem(146, 1, "present_temperature"),
    TableItem(147, 1, "backup_ready"),
    TableItem(152, 2, "external_port_data_1", "RW", 0, 0, 65535),
    TableItem(154, 2, "external_port_data_2", "RW", 0, 0, 65535),
    TableItem(156, 2, "external_port_data_3", "RW", 0, 0, 65535),
)
PRESENT = (120, 146)  # first and last address that change by themselves

_PORTS = tuple(f"external_port_{what}_{k}" for what in ("mode", "data") for k in (1, 2, 3))
_STARTUP = ("startup_configuration", "backup_ready")
_CURRENT = ("current_limit", "goal_current")
_X430 = (*_PORTS, "pwm_slope")
_LOAD = (*_X430, *_CURRENT)
_BIG = (IndirectAddresses(168, 224, 28), IndirectAddresses(578, 634, 28))
_SMALL = (IndirectAddresses(168, 208, 20),)

Limits = tuple[int, int, int]  # default, low, high


@dataclass(frozen=True)
class XSeriesModel:
    """Description of one model of the X series.

    Attributes:
        name: Name on the data sheet.
        number: Model number.
        modes: Operating modes that it supports.
        current_unit: Unit of register 126, A, or None where that is the load in 0.1 %.
        lacks: Registers that it does not have.
        changed: (default, low, high) of the registers that differ from `REGISTERS`.
        indirect: Its indirect addresses.
        firmware: Firmware version that it ships with.
        fast_since: First firmware version with fast sync read, or None.
        bauds: Number of baud rate codes.
    """

    name: str
    number: int
    modes: tuple[int, ...] = SIX_MODES
    current_unit: float | None = 2.69e-3
    lacks: tuple[str, ...] = _X430
    changed: dict[str, Limits] = field(default_factory=dict)
    indirect: tuple[IndirectAddresses, ...] = _BIG
    firmware: int = 48
    fast_since: int | None = 45
    bauds: int = 8

    def registers(self) -> RegisterFile:
        """Return a new control table with the factory defaults."""
        changed = {
            **self.changed,
            "model_number": (self.number, 0, 0),
            "firmware_version": (self.firmware, 0, 0),
            "baud_rate": (1, 0, self.bauds - 1),
        }
        items = [
            TableItem(*item[:4], *changed[item.name]) if item.name in changed else item
            for item in REGISTERS
            if item.name not in self.lacks
        ]
        return RegisterFile(items, self.indirect)


def _gains(p: int, velocity_i: int, velocity_p: int = 100, d: int = 0) -> dict[str, Limits]:
    values = {"position_p_gain": p, "position_d_gain": d,
              "velocity_i_gain": velocity_i, "velocity_p_gain": velocity_p}  # fmt: skip
    return {name: (value, 0, 16383) for name, value in values.items()}


def _volts(low: int, high: int, default_low: int | None = None) -> dict[str, Limits]:
    start = low if default_low is None else default_low
    return {"min_voltage_limit": (start, low, high), "max_voltage_limit": (high, low, high)}


def _speed(default: int, high: int = 1023) -> dict[str, Limits]:
    return {"velocity_limit": (default, 0, high)}


def _heat(limit: int) -> dict[str, Limits]:
    return {"temperature_limit": (limit, 0, 100)}


def _amps(limit: int) -> dict[str, Limits]:
    return {"current_limit": (limit, 0, limit)}


def _x330(number: int, name: str, milliamps: int, changed: dict[str, Limits]) -> XSeriesModel:
    return XSeriesModel(
        name, number, SIX_MODES, 1.0e-3, _PORTS,
        {**_heat(70), **_amps(milliamps), "protocol_type": (2, 2, 22), **changed},
        _SMALL, firmware=52, fast_since=46, bauds=7,
    )  # fmt: skip


def _load(number: int, name: str, changed: dict[str, Limits], twin: bool = False) -> XSeriesModel:
    """Return a model without current sensing; a `twin` has two axes in one housing."""
    return XSeriesModel(
        name, number, FOUR_MODES, None, (*_LOAD, *_STARTUP) if twin else _LOAD, changed,
        fast_since=None if twin else 45,
    )  # fmt: skip


_SLOPE = {"pwm_slope": (255, 1, 255)}
_X540 = {**_gains(800, 1920), **_amps(2047)}

MODELS: Final = {
    model.name: model
    for model in (
        XSeriesModel("XM430-W350", 1020, changed=_speed(200)),
        XSeriesModel("XM430-W210", 1030, changed=_speed(330)),
        _load(1060, "XL430-W250", {**_gains(640, 1000, 100, 4000), **_volts(60, 140), **_heat(72),
                                   **_speed(265)}),
        _load(1080, "XC430-W240", {**_gains(700, 1920), **_volts(60, 160), **_speed(306)}),
        _load(1070, "XC430-W150", {**_gains(460, 1920), **_volts(60, 160), **_speed(460),
                                   "moving_threshold": (20, 0, 1023)}),
        _load(1090, "2XL430-W250", {**_gains(640, 1800, 100, 2000), **_volts(60, 140), **_heat(72),
                                    **_speed(250)}, twin=True),
        _load(1160, "2XC430-W250", {**_gains(700, 1920), **_volts(60, 160), **_speed(275)},
              twin=True),
        _x330(1220, "XC330-T288", 910, {**_gains(900, 1200, 40), **_volts(55, 140), **_SLOPE,
                                        **_speed(320, 2047)}),
        _x330(1240, "XC330-M288", 1800, {**_gains(900, 1200, 40), **_volts(31, 70, 35), **_SLOPE,
                                         **_speed(425, 2047)}),
        _x330(1200, "XL330-M288", 1750, {**_gains(400, 1600, 180), **_volts(31, 70, 35),
                                         **_speed(445, 2047), "shutdown": (53, 0, 63)}),
        _x330(1190, "XL330-M077", 1750, {**_gains(400, 400, 40), **_volts(31, 70, 35),
                                         **_speed(1620, 2047), "shutdown": (53, 0, 63),
                                         "position_i_gain": (400, 0, 16383)}),
        XSeriesModel("XM540-W270", 1120, lacks=("pwm_slope",), changed={**_X540, **_speed(128)}),
        XSeriesModel("XM540-W150", 1130, lacks=("pwm_slope",), changed={**_X540, **_speed(230)}),
        XSeriesModel("XH540-W270", 1100, lacks=("pwm_slope",), changed={**_X540, **_speed(167)}),
    )
}  # fmt: skip


def model(name: str) -> XSeriesModel:
    """Return the model `name`; a family's short name ("XL430") means its first model.

    Raises:
        UnknownNameError: There is no such model.
    """
    for known in MODELS.values():
        if known.name == name or known.name.split("-")[0] == name:
            return known
    raise UnknownNameError("servo model", name, MODELS)
