"""The keywords that the fault methods share."""

from collections.abc import Iterable
from typing import TypedDict

from windup.sim_twin.wire.faults.fault_rule import Times


class When(TypedDict, total=False):
    """How often a fault happens, or when.

    Attributes:
        rate: Share of the answers that it hits, 0 to 1. By default 0.01 for a fault of answers; an
            event (`dead`, `overload`, `unplug`, ...) happens once, now, unless a rate is given.
        at: Instead of a rate the world's time, s, or several: the first answer from then on is
            hit, or servos, supply and adapter at that very moment.
        bus: Name of the bus it is confined to; all by default.
    """

    rate: float
    at: Times
    bus: str


class Who(When, total=False):
    """How often or when, and whom.

    Attributes:
        ids: The servo ids that can be hit; all by default.
    """

    ids: Iterable[int]
