"""Control tables of Feetech STS and SCS servos: one line per register.

From Feetech's memory tables. STS servos have a magnetic encoder, send the low byte first and use a
different sign bit for each register; SCS servos have a potentiometer and send the high byte first.
Values that the tables do not state are marked.
"""

from dataclasses import dataclass
from typing import Final

from windup.sim_twin.wire.servos.byte_table import ByteTable, Field

EEPROM_END = 40
CURRENT_UNIT = 6.5e-3  # A
SPEED_STEP = 50  # coarse unit of speed, steps/s
ACCELERATION_STEP = 100  # steps/s2

BAUDS: Final = {  # below 115200 Feetech's and its users' tables differ; these are Feetech's
    **{1_000_000: 0, 500_000: 1, 250_000: 2, 128_000: 3, 115_200: 4},
    **{76_800: 5, 57_600: 6, 38_400: 7},
}

_COMMON = (
    Field(0, 1, "firmware_major", default=3),
    Field(1, 1, "firmware_minor", default=9),
    Field(2, 1, "end"),
    Field(3, 2, "model_number"),
    Field(5, 1, "id", "RW", 1, 0, 253),
    Field(6, 1, "baud_rate", "RW", 0, 0, 7),
    Field(7, 1, "return_delay_time", "RW", 0, 0, 254),
    Field(8, 1, "status_return_level", "RW", 1, 0, 1),
    Field(13, 1, "max_temperature", "RW", 70, 0, 100),
    Field(14, 1, "max_voltage", "RW", 80, 0, 254),
    Field(15, 1, "min_voltage", "RW", 40, 0, 254),
    Field(16, 2, "max_torque", "RW", 1000, 0, 1000),
    Field(18, 1, "phase", "RW", 12, 0, 254),
    Field(19, 1, "unloading_condition", "RW", 44, 0, 254),
    Field(20, 1, "led_alarm", "RW", 47, 0, 254),
    Field(21, 1, "p_gain", "RW", 32, 0, 254),
    Field(22, 1, "d_gain", "RW", 32, 0, 254),
    Field(23, 1, "i_gain", "RW", 0, 0, 254),
    Field(24, 2, "min_startup_force", "RW", 16, 0, 1000),
    Field(26, 1, "cw_dead_zone", "RW", 1, 0, 32),
    Field(27, 1, "ccw_dead_zone", "RW", 1, 0, 32),
    Field(40, 1, "torque_enable", "RW", 0, 0, 128),
    Field(41, 1, "acceleration", "RW", 0, 0, 254),
    Field(60, 2, "present_load", sign=10),
    Field(62, 1, "present_voltage"),
    Field(63, 1, "present_temperature"),
    Field(64, 1, "registered"),
    Field(65, 1, "status"),
    Field(66, 1, "moving"),
)
_STS = (
    Field(9, 2, "min_angle", "RW", 0, -32767, 32767, 15),
    Field(11, 2, "max_angle", "RW", 4095, -32767, 32767, 15),
    Field(28, 2, "protection_current", "RW", 500, 0, 2047),
    Field(30, 1, "angular_resolution", "RW", 1, 1, 3),
    Field(31, 2, "offset", "RW", 0, -2047, 2047, 11),
    Field(33, 1, "mode", "RW", 0, 0, 3),
    Field(34, 1, "protective_torque", "RW", 20, 0, 100),
    Field(35, 1, "protection_time", "RW", 200, 0, 254),
    Field(36, 1, "overload_torque", "RW", 80, 0, 100),
    Field(37, 1, "speed_p_gain", "RW", 10, 0, 254),
    Field(38, 1, "overcurrent_time", "RW", 200, 0, 254),
    Field(39, 1, "speed_i_gain", "RW", 200, 0, 254),
    Field(42, 2, "goal_position", "RW", 0, -32767, 32767, 15),
    Field(44, 2, "goal_time", "RW", 0, -1000, 1000, 10),
    Field(46, 2, "goal_speed", "RW", 0, -32767, 32767, 15),
    Field(48, 2, "torque_limit", "RW", 1000, 0, 1000),
    Field(55, 1, "lock", "RW", 1, 0, 1),
    Field(56, 2, "present_position", sign=15),
    Field(58, 2, "present_speed", sign=15),
    Field(69, 2, "present_current", sign=15),
    Field(80, 1, "moving_threshold", "RW", 1, 0, 254),
    Field(81, 1, "dts", "RW", 20, 0, 254),
    Field(82, 1, "speed_unit_factor", "RW", 1, 0, 254),
    Field(83, 1, "hts", "RW", 20, 0, 254),
    Field(84, 1, "max_speed", "RW", 68, 0, 254),  # 3400 steps/s, measured by bam
    Field(85, 1, "max_acceleration", "RW", 0, 0, 254),  # 0: no limit, assumed
    Field(86, 1, "acceleration_factor", "RW", 1, 0, 254),
)
_SCS = (
    Field(9, 2, "min_angle", "RW", 0, 0, 1023),
    Field(11, 2, "max_angle", "RW", 1023, 0, 1023),
    Field(37, 1, "protective_torque", "RW", 20, 0, 100),
    Field(38, 1, "protection_time", "RW", 200, 0, 254),
    Field(39, 1, "overload_torque", "RW", 80, 0, 100),
    Field(42, 2, "goal_position", "RW", 0, 0, 1023),
    Field(44, 2, "goal_time", "RW", 0, 0, 0x7FFF),  # in wheel mode the PWM, with sign bit 10
    Field(46, 2, "goal_speed", "RW", 0, 0, 0x7FFF),
    Field(48, 1, "lock", "RW", 1, 0, 1),
    Field(56, 2, "present_position"),
    Field(58, 2, "present_speed", sign=15),
)


@dataclass(frozen=True)
class FeetechModel:
    """Description of one model.

    Attributes:
        name: Name on the data sheet.
        number: Model number.
        magnetic: True for STS, with a magnetic encoder; False for SCS.
        changed: Registers with other defaults, and these defaults.
    """

    name: str
    number: int
    magnetic: bool = True
    changed: tuple[tuple[str, int], ...] = ()

    def table(self) -> ByteTable:
        """Return a new control table with the factory defaults."""
        changed = {"model_number": self.number, **dict(self.changed)}
        fields = [
            field._replace(default=changed.get(field.name, field.default))
            for field in (*_COMMON, *(_STS if self.magnetic else _SCS))
        ]
        return ByteTable(fields, EEPROM_END, big=not self.magnetic)


_12V = (("max_voltage", 140),)

MODELS: Final = {
    model.name: model
    for model in (
        FeetechModel("STS3215-7.4V", 777),
        FeetechModel("STS3215-12V", 777, changed=_12V),
        FeetechModel("STS3250", 2825, changed=_12V),
        FeetechModel("SCS0009", 1284, False, (("p_gain", 15), ("d_gain", 0), ("end", 1))),
    )
}
