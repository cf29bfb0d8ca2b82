"""A bus of a served world, with the link through which a program uses it."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from windup.sim_twin.wire.bus.bus import BITS, Bus
from windup.sim_twin.wire.serve.link import Link

CHUNK_TIME = 0.0006  # duration of the pieces in which an answer is sent, s
WAITING: Final = 65_536  # largest number of a program's bytes that wait; more are lost
AT_ONCE: Final = 262_144  # largest number of bytes that are read from a link at once
ON_THE_WIRE: Final = 0.010  # longest time of a program's bytes that the bus queues ahead, s


@dataclass
class BusOutlet:
    """A bus, its link, and the bytes that wait between them.

    Bytes from a program are read from its link at once, so that a program that flushes its output
    loses as little as possible, and are put on the wire at the wire's speed. Bytes beyond `WAITING`
    are lost, as in an adapter without flow control: a program that sends megabytes and disconnects
    neither fills the memory nor makes later programs wait for seconds.

    Attributes:
        bus: The bus.
        make: Makes the link, at the start and each time that the adapter is plugged in again.
        link: The link; None while the adapter is unplugged.
        name: Path or URL that a program has to open.
        sent: Time at which bytes were sent to the program last, s.
        waiting: Bytes from the program that are not on the wire yet.
    """

    bus: Bus
    make: Callable[[], Link]
    link: Link | None = None
    name: str = ""
    sent: float = -math.inf
    waiting: bytearray = field(default_factory=bytearray)

    def update_link(self) -> None:
        """Open or close the link, according to whether the bus is plugged in."""
        if self.bus.plugged and self.link is None:
            self.link = self.make()
            self.name = self.link.name
        elif not self.bus.plugged and self.link is not None:
            self.link.close()
            self.link = None
            self.waiting.clear()

    def descriptors(self) -> list[int]:
        """Return the descriptors to wait for."""
        return [] if self.link is None else self.link.descriptors()

    def due(self, more: bool) -> float:
        """Return when bytes should be sent to the program next, s.

        The first and the last byte of an answer are sent as they arrive, those between in pieces.
        `more`: the end of the answer has not been computed yet.
        """
        bus = self.bus
        if not bus.queued:
            return math.inf
        piece = max(bus.arrival(1), self.sent + CHUNK_TIME)
        return piece if more else min(bus.arrival(bus.queued), piece)

    def send(self, now: float) -> None:
        """Send the bytes that have arrived."""
        if (data := self.bus.read(self.bus.available())) and self.link is not None:
            self.link.send(data)
            self.sent = now

    def receive(self) -> None:
        """Read what the program has sent, dated no earlier than the last bytes sent to it.

        A fast program replies sooner than the two hops and would collide with the answer's end.
        """
        schedule, link = self.bus.schedule, self.link
        schedule.now = max(schedule.now, self.sent)
        if link is not None and (data := link.receive(AT_ONCE)):
            if baud := link.baud():
                self.bus.baud = baud
            self.waiting += data[: WAITING - len(self.waiting)]
            self.feed()

    def feed(self) -> None:
        """Put on the wire as many bytes as it carries within `ON_THE_WIRE`."""
        if self.waiting:
            room = int((ON_THE_WIRE - self.bus.backlog) * self.bus.baud / BITS)
            if room > 0:
                self.bus.write(bytes(self.waiting[:room]))
                del self.waiting[:room]
