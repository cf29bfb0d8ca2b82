"""The settings of a servo that the stack relies on: read, written where they differ, read back."""

from typing import NamedTuple

from hal.bus import Bus
from hal.registers import Register, RegisterTable

POSITION_MODE = 3
PWM_FULL = 885

# What the torque law and the cyclic traffic assume, in the order in which it is written.
WANTED = (
    ("return_delay", 0),
    ("drive_mode", 0),  # counts up, velocity profile, a goal does not switch torque on
    ("operating_mode", POSITION_MODE),
    ("pwm_limit", PWM_FULL),
    ("min_position_limit", 0),  # a goal beyond these is ignored without a word
    ("max_position_limit", 4095),
    ("startup_configuration", 0),  # no torque after a brown-out
    ("status_return_level", 2),
    ("bus_watchdog", 0),
    ("goal_pwm", PWM_FULL),
    ("profile_velocity", 0),
    ("profile_acceleration", 0),
    ("position_i_gain", 0),
    ("position_d_gain", 0),
    ("feedforward_1st_gain", 0),
    ("feedforward_2nd_gain", 0),
)


class Setting(NamedTuple):
    """A register that is not as the stack needs it."""

    register: Register
    present: int
    wanted: int

    def __str__(self) -> str:
        return f"{self.register.name} {self.present} instead of {self.wanted}"


def differences(bus: Bus, id: int, table: RegisterTable) -> list[Setting]:
    """Return the settings of servo `id` that differ. Nothing is written."""
    found = []
    for name, wanted in WANTED:
        if name in table and (present := bus.read(id, table[name])) != wanted:
            found.append(Setting(table[name], present, wanted))
    return found


def assert_settings(bus: Bus, id: int, settings: list[Setting]) -> None:
    """Write `settings` and read each one back.

    Raises:
        HardwareError: The servo refuses, or reads back something else.
    """
    for setting in settings:
        bus.write(id, setting.register, setting.wanted)
