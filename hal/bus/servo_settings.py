"""The required settings of a servo: compared, written where they differ, and read back."""

from typing import NamedTuple

from windup.hal.bus.bus import Bus
from windup.hal.families.family import Family, RequiredSetting
from windup.hal.registers import Register
from windup.hal.servos.servo_model import ServoModel, ServoMount


class SettingDifference(NamedTuple):
    """A register whose present value differs from the wanted one, counts."""

    register: Register
    present: int
    wanted: int

    def __str__(self) -> str:
        return f"{self.register.name} {self.present} instead of {self.wanted}"


def differences(bus: Bus, mount: ServoMount) -> list[SettingDifference]:
    """Return the required settings of a servo that differ. Nothing is written."""
    table = bus.family.table(mount.model.name)
    found = []
    for name, value, mask in required_settings(bus.family, mount):
        if name not in table:
            continue
        present = bus.read(mount.id, table[name])
        wanted = value if mask is None else present & ~mask | value
        if present != wanted:
            found.append(SettingDifference(table[name], present, wanted))
    return found


def required_settings(family: Family, mount: ServoMount) -> list[RequiredSetting]:
    """Return the required settings of a servo, in the order in which they are written."""
    other = family.extended if mount.extended else None
    return [
        other if other is not None and setting.name == other.name else setting
        for setting in family.required(mount.model)
    ]


def limits(bus: Bus, id: int, model: ServoModel) -> list[SettingDifference]:
    """Return the unusual protection registers of servo `id`; `wanted` is the factory default."""
    table = bus.family.table(model.name)
    found = []
    for default in bus.family.factory_defaults(model):
        if default.name not in table:
            continue
        present = bus.read(id, table[default.name])
        if default.is_unusual(present):
            found.append(SettingDifference(table[default.name], present, default.value))
    return found


def assert_settings(bus: Bus, id: int, settings: list[SettingDifference]) -> None:
    """Write `settings` and read each one back.

    Raises:
        HardwareError: The servo refuses a write, or reads back another value.
    """
    for setting in settings:
        bus.write(id, setting.register, setting.wanted)
