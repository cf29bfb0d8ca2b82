"""Record of the registers of a servo that differ from the required settings."""

from typing import NamedTuple

from windup.hal.bus.bus import Bus
from windup.hal.bus.servo_settings import SettingDifference


class ServoDifferences(NamedTuple):
    """Registers of one servo that differ from the required settings or the factory defaults.

    Attributes:
        bus: Its bus.
        id: Its id on the bus.
        joint: Name of its joint.
        settings: Registers that have to be written.
        limits: Protection registers that differ from the factory defaults; they are not changed.
        repaired: Description of a write that was needed to make it answer; "" for none.
    """

    bus: Bus
    id: int
    joint: str
    settings: list[SettingDifference]
    limits: list[SettingDifference]
    repaired: str
