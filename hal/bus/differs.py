"""What a servo holds that is not as the stack needs it."""

from typing import NamedTuple

from windup.hal.bus.bus import Bus
from windup.hal.bus.servo_settings import Setting


class Differs(NamedTuple):
    """What one servo holds that is not as the stack needs it.

    Attributes:
        bus: Its bus.
        id: Its id there.
        joint: Its joint's name.
        settings: What has to be written.
        limits: How it protects itself otherwise than it is delivered; that stays.
        repaired: What had to be written already for it to answer, in words; "" for nothing.
    """

    bus: Bus
    id: int
    joint: str
    settings: list[Setting]
    limits: list[Setting]
    repaired: str
