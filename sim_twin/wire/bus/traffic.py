"""The bytes in transit on a wire, which are corrupted where two senders overlap."""

import math
from collections.abc import Callable
from typing import Final

from windup.sim_twin.wire.bus.inbox import Burst

EPSILON: Final = 1e-9
"""Shorter overlaps do not count as collisions, s."""


class Traffic:
    """The bursts that are or soon will be in transit on a wire."""

    def __init__(self) -> None:
        self._bursts: list[Burst] = []

    def add(self, new: Burst, now: float, noise: Callable[[int], bytes]) -> int:
        """Add a burst, corrupt the bytes that overlap with others, and return the collision count.

        Args:
            new: The burst.
            now: Time, s; bursts that ended before are removed.
            noise: Returns the given number of random bytes.
        """
        collisions = 0
        on_wire = [old for old in self._bursts if old.end > now]
        for old in on_wire:
            start, end = max(old.start, new.start), min(old.end, new.end)
            if start >= end - EPSILON:
                continue
            collisions += 1
            for burst in (old, new):
                first = max(0, int((start - burst.start) / burst.byte_time))
                last = min(len(burst.data), math.ceil((end - burst.start) / burst.byte_time))
                if last > first:
                    burst.data[first:last] = noise(last - first)
                    burst.corrupted = min(burst.corrupted, start)
        on_wire.append(new)
        self._bursts = on_wire
        return collisions
