"""The receive queue of a host: bytes received from a bus or still in transit."""

import math
from collections import deque
from dataclasses import dataclass


@dataclass(slots=True)
class Burst:
    """Consecutive bytes on the wire.

    Attributes:
        start: Start of the first byte, s.
        byte_time: Duration of each byte, s.
        data: The bytes.
        corrupted: Time from which a collision has corrupted them, s.
        held_until: Time before which the host's adapter does not deliver them, s.
    """

    start: float
    byte_time: float
    data: bytearray
    corrupted: float = math.inf
    held_until: float = 0.0

    @property
    def end(self) -> float:
        """End of the last byte, s."""
        return self.start + len(self.data) * self.byte_time


class Inbox:
    """Bursts in the order in which the host receives them.

    Attributes:
        latency: Latency from a byte's end on the wire until the host has it, s.
        queued: Number of bytes that the host has not read, received or in transit.
    """

    def __init__(self, latency: float) -> None:
        self.latency = latency
        self.queued = 0
        self._bursts: deque[Burst] = deque()
        self._taken = 0  # number of bytes of the first burst that the host has read

    def append(self, burst: Burst) -> None:
        """Append a burst."""
        self._bursts.append(burst)
        self.queued += len(burst.data)

    @property
    def last(self) -> Burst | None:
        """The burst appended last, or None if the host has read all of it."""
        return self._bursts[-1] if self._bursts else None

    def clear(self) -> None:
        """Discard all bytes."""
        self._bursts.clear()
        self.queued = self._taken = 0

    def available(self, now: float) -> int:
        """Return the number of bytes that the host has received by `now`, s, and not read."""
        total = -self._taken
        for burst in self._bursts:
            if burst.held_until > now:
                break
            arrived = int((now - self.latency - burst.start) / burst.byte_time + 1e-6)
            total += max(0, min(arrived, len(burst.data)))
            if arrived < len(burst.data):
                break
        return max(total, 0)

    def arrival(self, count: int) -> float:
        """Return when the host has `count` bytes, s; infinity if fewer are in transit."""
        if count > self.queued:
            return math.inf
        count += self._taken
        floor = 0.0
        for burst in self._bursts:
            floor = max(floor, burst.held_until)
            if count <= len(burst.data):
                return max(floor, burst.start + count * burst.byte_time + self.latency)
            count -= len(burst.data)
        return math.inf

    def read(self, count: int, now: float) -> bytes:
        """Return up to `count` bytes that the host has received by `now`, s."""
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
