"""Latencies of adapters and servos."""

from typing import NamedTuple


class Timing(NamedTuple):
    """Timing that differs between adapters and between servos, and that no manual states.

    Attributes:
        latency: Latency from a byte's end on the wire until the host has it, s.
        turnaround: Time added to every return delay, s.
        waits: Behaviour after a missing servo in a sync read. True: the later servos wait for it
            for ever; False: they answer when its slot has passed.
    """

    latency: float = 0.0
    turnaround: float = 0.0
    waits: bool = False
