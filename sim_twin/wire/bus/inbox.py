"""What a host has got, or will get, from a bus."""

import math
from collections import deque
from dataclasses import dataclass


@dataclass(slots=True)
class Burst:
    """Bytes on the wire, one after the other.

    Attributes:
        start: When the first one begins, s.
        byte: How long each takes, s.
        data: What they are.
        ruined: From when on they are noise, s.
        held: Before when the host's adapter does not give them away, s.
    """

    start: float
    byte: float
    data: bytearray
    ruined: float = math.inf
    held: float = 0.0

    @property
    def end(self) -> float:
        """When the last one ends, s."""
        return self.start + len(self.data) * self.byte


class Inbox:
    """Bursts in the order in which the host gets them.

    Attributes:
        latency: From a byte's end on the wire to the host having it, s.
        queued: Bytes that the host has not read, arrived or on the way.
    """

    def __init__(self, latency: float) -> None:
        self.latency = latency
        self.queued = 0
        self._bursts: deque[Burst] = deque()
        self._taken = 0  # bytes of the first burst that the host has

    def append(self, burst: Burst) -> None:
        """Put a burst behind the others."""
        self._bursts.append(burst)
        self.queued += len(burst.data)

    @property
    def last(self) -> Burst | None:
        """The burst that came last, unless the host has read it."""
        return self._bursts[-1] if self._bursts else None

    def clear(self) -> None:
        """Lose everything."""
        self._bursts.clear()
        self.queued = self._taken = 0

    def available(self, now: float) -> int:
        """Return the number of bytes that the host has at `now` s and has not read."""
        total = -self._taken
        for burst in self._bursts:
            if burst.held > now:
                break
            arrived = int((now - self.latency - burst.start) / burst.byte + 1e-6)
            total += max(0, min(arrived, len(burst.data)))
            if arrived < len(burst.data):
                break
        return max(total, 0)

    def arrival(self, count: int) -> float:
        """Return when the host has `count` bytes, s; infinity if they are not on the way yet."""
        if count > self.queued:
            return math.inf
        count += self._taken
        floor = 0.0
        for burst in self._bursts:
            floor = max(floor, burst.held)
            if count <= len(burst.data):
                return max(floor, burst.start + count * burst.byte + self.latency)
            count -= len(burst.data)
        return math.inf

    def read(self, count: int, now: float) -> bytes:
        """Return up to `count` bytes of those that the host has at `now` s."""
        count = min(count, self.available(now))
        data = bytearray()
        while count > 0:
            first = self._bursts[0]
            piece = first.data[self._taken : self._taken + count]
            data += piece
            count -= len(piece)
            self.queued -= len(piece)
            self._taken += len(piece)
            if self._taken == len(first.data):
                self._bursts.popleft()
                self._taken = 0
        return bytes(data)
