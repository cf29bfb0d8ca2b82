"""Latencies of adapters and servos."""

from typing import NamedTuple


class Timing(NamedTuple):
    """Timing that differs between adapters and between servos, and that no manual states.

    Attributes:
        latency: Latency from a byte's end on the wire until the host has it, s.
        turnaround: Time added to every return delay, s.
        waits_for_missing: Whether, in a sync read, the servos after a missing one wait for it for
            ever; if not, they answer when its slot has passed.
    """

    latency: float = 0.0
    turnaround: float = 0.0
    waits_for_missing: bool = False
