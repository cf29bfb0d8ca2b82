"""A bus of a world that runs by the wall clock, and the plug into which a program may come."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from windup.sim_twin.wire.bus.bus import BITS, Bus
from windup.sim_twin.wire.serve.link import Link

CHUNK_TIME = 0.0006  # s of bytes that go out together in the middle of an answer
WAITING: Final = 65_536  # bytes of a program that wait for the wire; more are lost
AT_ONCE: Final = 262_144  # bytes that are taken off a link together
ON_THE_WIRE: Final = 0.010  # s of a program's bytes that the bus knows of ahead of their time


@dataclass
class Outlet:
    """A bus, its plug, and when bytes go out next.

    What a program sends is taken off its link at once, so that a program that flushes its output
    loses as little as the kernel lets it, and put on the wire as fast as the wire is. What does not
    fit into `WAITING` is lost, as in an adapter without flow control: whoever sends megabytes and
    goes neither fills the memory nor has those who come later wait for seconds.

    Attributes:
        bus: The bus.
        make: Makes its plug, at the start and each time that the adapter is plugged in again.
        link: The plug; None while the adapter is unplugged.
        name: What a program has to open.
        sent: When bytes went out last, s.
        waiting: What the program has sent and is not on the wire yet.
    """

    bus: Bus
    make: Callable[[], Link]
    link: Link | None = None
    name: str = ""
    sent: float = -math.inf
    waiting: bytearray = field(default_factory=bytearray)

    def settle(self) -> None:
        """Pull the plug, or put it in, as the bus has it."""
        if self.bus.plugged and self.link is None:
            self.link = self.make()
            self.name = self.link.name
        elif not self.bus.plugged and self.link is not None:
            self.link.close()
            self.link = None
            self.waiting.clear()

    def descriptors(self) -> list[int]:
        """Return what to wait for."""
        return [] if self.link is None else self.link.descriptors()

    def due(self, more: bool) -> float:
        """Return when bytes should go out next, s.

        The first and the last of an answer go out as they arrive, those between in pieces. `more`
        says that the end of the answer has still to be worked out.
        """
        bus = self.bus
        if not bus.queued:
            return math.inf
        piece = max(bus.arrival(1), self.sent + CHUNK_TIME)
        return piece if more else min(bus.arrival(bus.queued), piece)

    def send(self, now: float) -> None:
        """Send what has arrived."""
        if (data := self.bus.read(self.bus.available())) and self.link is not None:
            self.link.send(data)
            self.sent = now

    def receive(self) -> None:
        """Take in what the program has sent: not before it had what it answers to.

        A fast program is back sooner than the two hops, and would talk into the answer's end.
        """
        schedule, link = self.bus.schedule, self.link
        schedule.now = max(schedule.now, self.sent)
        if link is not None and (data := link.receive(AT_ONCE)):
            if baud := link.baud():
                self.bus.baud = baud
            self.waiting += data[: WAITING - len(self.waiting)]
            self.feed()

    def feed(self) -> None:
        """Put as much on the wire as it takes within the next moment."""
        if self.waiting:
            room = int((ON_THE_WIRE - self.bus.backlog) * self.bus.baud / BITS)
            if room > 0:
                self.bus.write(bytes(self.waiting[:room]))
                del self.waiting[:room]
