"""Control tables of Dynamixel AX and MX with protocol 1: one line per register.

From the e-Manuals of AX-12A, MX-28, MX-64 and MX-106 (emanual.robotis.com/docs/en/dxl/). Speeds
and loads have their direction in bit 10: set is clockwise, against the counts.
"""

from dataclasses import dataclass
from math import pi
from typing import Final

from windup.sim_twin.wire.servos.byte_table import TWOS, ByteTable, Field

EEPROM_END = 24
RPM = 2.0 * pi / 60.0  # rad/s
CURRENT_UNIT = 4.5e-3  # A
CURRENT_ZERO = 2048
ACCELERATION_UNIT = 8.583 * pi / 180.0  # rad/s2
TURNS_7 = 28672  # counts

BAUDS: Final = {
    **{1_000_000: 1, 500_000: 3, 400_000: 4, 250_000: 7, 200_000: 9, 115_200: 16, 57_600: 34},
    **{19_200: 103, 9_600: 207, 2_000_000: 0, 2_250_000: 250, 2_500_000: 251, 3_000_000: 252},
}

_COMMON = (
    Field(0, 2, "model_number"),
    Field(2, 1, "firmware_version", default=36),
    Field(3, 1, "id", "RW", 1, 0, 253),
    Field(4, 1, "baud_rate", "RW", 34, 0, 254),
    Field(5, 1, "return_delay_time", "RW", 250, 0, 254),
    Field(11, 1, "temperature_limit", "RW", 80, 0, 100),
    Field(12, 1, "min_voltage_limit", "RW", 60, 50, 160),
    Field(13, 1, "max_voltage_limit", "RW", 160, 50, 160),
    Field(14, 2, "max_torque", "RW", 1023, 0, 1023),
    Field(16, 1, "status_return_level", "RW", 2, 0, 2),
    Field(17, 1, "alarm_led", "RW", 36, 0, 127),
    Field(18, 1, "shutdown", "RW", 36, 0, 127),
    Field(24, 1, "torque_enable", "RW", 0, 0, 1),
    Field(25, 1, "led", "RW", 0, 0, 1),
    Field(32, 2, "moving_speed", "RW", 0, 0, 2047),
    Field(34, 2, "torque_limit", "RW", 1023, 0, 1023),
    Field(38, 2, "present_speed", sign=10),
    Field(40, 2, "present_load", sign=10),
    Field(42, 1, "present_voltage"),
    Field(43, 1, "present_temperature"),
    Field(44, 1, "registered"),
    Field(46, 1, "moving"),
    Field(47, 1, "lock", "RW", 0, 0, 1),
)
_AX = (
    Field(6, 2, "cw_angle_limit", "RW", 0, 0, 1023),
    Field(8, 2, "ccw_angle_limit", "RW", 1023, 0, 1023),
    Field(26, 1, "cw_compliance_margin", "RW", 1, 0, 255),
    Field(27, 1, "ccw_compliance_margin", "RW", 1, 0, 255),
    Field(28, 1, "cw_compliance_slope", "RW", 32, 0, 254),
    Field(29, 1, "ccw_compliance_slope", "RW", 32, 0, 254),
    Field(30, 2, "goal_position", "RW", 0, 0, 1023),
    Field(36, 2, "present_position"),
    Field(48, 2, "punch", "RW", 32, 0, 1023),
)
_MX = (
    Field(6, 2, "cw_angle_limit", "RW", 0, 0, 4095),
    Field(8, 2, "ccw_angle_limit", "RW", 4095, 0, 4095),
    Field(20, 2, "multi_turn_offset", "RW", 0, -24576, 24576, TWOS),
    Field(22, 1, "resolution_divider", "RW", 1, 1, 4),
    Field(26, 1, "d_gain", "RW", 0, 0, 254),
    Field(27, 1, "i_gain", "RW", 0, 0, 254),
    Field(28, 1, "p_gain", "RW", 32, 0, 254),
    Field(30, 2, "goal_position", "RW", 0, -TURNS_7, TURNS_7, TWOS),
    Field(36, 2, "present_position", sign=TWOS),
    Field(48, 2, "punch", "RW", 0, 0, 1023),
    Field(50, 2, "realtime_tick"),
    Field(73, 1, "goal_acceleration", "RW", 0, 0, 254),
)
_SENSED = (
    Field(68, 2, "current", default=CURRENT_ZERO),
    Field(70, 1, "torque_control_mode", "RW", 0, 0, 1),
    Field(71, 2, "goal_torque", "RW", 0, 0, 2047),
)
_DRIVE_MODE = (Field(10, 1, "drive_mode", "RW", 0, 0, 3),)


@dataclass(frozen=True)
class Dynamixel1Model:
    """Description of one model.

    Attributes:
        name: Name on the data sheet.
        number: Model number.
        fields: The fields that it has besides the common ones.
        speed_unit: Unit of the speed registers, rad/s.
        changed: Registers with other defaults, and these defaults.
    """

    name: str
    number: int
    fields: tuple[Field, ...]
    speed_unit: float = 0.114 * RPM
    changed: tuple[tuple[str, int], ...] = ()

    def table(self) -> ByteTable:
        """Return a new control table with the factory defaults."""
        changed = {"model_number": self.number, **dict(self.changed)}
        fields = [
            field._replace(default=changed.get(field.name, field.default))
            for field in (*_COMMON, *self.fields)
        ]
        return ByteTable(fields, EEPROM_END)


_AX_12A = (
    ("baud_rate", 1),
    ("temperature_limit", 70),
    ("max_voltage_limit", 140),
    ("firmware_version", 24),
)

MODELS: Final = {
    model.name: model
    for model in (
        Dynamixel1Model("AX-12A", 12, _AX, 0.111 * RPM, _AX_12A),
        Dynamixel1Model("MX-28", 29, _MX),
        Dynamixel1Model("MX-64", 310, (*_MX, *_SENSED)),
        Dynamixel1Model("MX-106", 320, (*_MX, *_SENSED, *_DRIVE_MODE)),
    )
}
