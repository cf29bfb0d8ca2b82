"""How long adapters and servos take."""

from typing import NamedTuple


class Timing(NamedTuple):
    """What differs between adapters and between servos, and no manual says.

    Attributes:
        latency: From a byte's end on the wire to the host having it, s.
        turnaround: Added to every return delay, s.
        waits: Behind a missing servo in a sync read: True, the others wait for it for ever;
            False, they answer when its slot has passed.
    """

    latency: float = 0.0
    turnaround: float = 0.0
    waits: bool = False
