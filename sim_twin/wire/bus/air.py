"""What is on a wire at one time, and what becomes of it where two senders overlap."""

import math
from collections.abc import Callable
from typing import Final

from windup.sim_twin.wire.bus.inbox import Burst

EPSILON: Final = 1e-9
"""Overlaps that are shorter are none, s."""


class Air:
    """The bursts that are on a wire now or soon."""

    def __init__(self) -> None:
        self._bursts: list[Burst] = []

    def add(self, new: Burst, now: float, noise: Callable[[int], bytes]) -> int:
        """Put a burst there, make noise of what overlaps; return how often it collides.

        Args:
            new: The burst.
            now: Time, s: what has ended before is forgotten.
            noise: Returns so many bytes as of a collision.
        """
        collisions = 0
        air = [old for old in self._bursts if old.end > now]
        for old in air:
            start, end = max(old.start, new.start), min(old.end, new.end)
            if start >= end - EPSILON:
                continue
            collisions += 1
            for burst in (old, new):
                first = max(0, int((start - burst.start) / burst.byte))
                last = min(len(burst.data), math.ceil((end - burst.start) / burst.byte))
                if last > first:
                    burst.data[first:last] = noise(last - first)
                    burst.ruined = min(burst.ruined, start)
        air.append(new)
        self._bursts = air
        return collisions
