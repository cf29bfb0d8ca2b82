"""The keywords that all fault methods accept."""

from collections.abc import Iterable
from typing import TypedDict

from windup.sim_twin.wire.faults.fault_rule import Times


class TimeKeywords(TypedDict, total=False):
    """Rate or times of a fault.

    Attributes:
        rate: Share of the answers that are hit, 0 to 1. The default is 0.01 for a fault of answers;
            an event (`dead`, `overload`, `unplug`, ...) without a rate happens once, now.
        at: One or several times in the world instead of a rate, s: the first answer from then on is
            hit; an event happens at that time.
        bus: Name of the bus that the fault is limited to; all buses by default.
    """

    rate: float
    at: Times
    bus: str


class TargetKeywords(TimeKeywords, total=False):
    """Rate or times of a fault, and its targets.

    Attributes:
        ids: Ids of the devices that can be hit, or the id of one; all by default.
    """

    ids: Iterable[int] | int
