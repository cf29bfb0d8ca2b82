"""Faults that hit a status packet between a device and the host."""

import math
import random
from dataclasses import dataclass
from functools import partial

from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.bus.inbox import Burst
from windup.sim_twin.wire.bus.spoilt import spoil


@dataclass
class Fate:
    """The faults that apply to one status packet.

    Attributes:
        got: The bytes that the host receives.
        before: The device's previous status packet of the same length.
        late: Additional delay before the device sends it, s.
        held: Time until which the adapter holds it back, s.
        glued: Longest time for which the adapter waits to deliver it with the next one, s.
        torn: Index of the first byte that the adapter holds back, and for how long, s.
    """

    got: bytes
    before: bytes = b""
    late: float = 0.0
    held: float = 0.0
    glued: float = 0.0
    torn: tuple[int, float] | None = None

    def suffer(self, kind: str, seconds: float, bus: Bus, dice: random.Random) -> None:
        """Apply one fault of `fault_rule.ANSWERS`."""
        if kind == "late":
            self.late += seconds
        elif kind == "delay":
            self.held = max(self.held, bus.schedule.now + seconds)
        elif kind == "glue":
            self.glued = seconds
        elif kind == "late_byte":
            self.torn = dice.randrange(len(self.got)), seconds
        elif kind == "stale":
            self.got = self.before
        else:
            self.got = spoil(kind, self.got, bus.protocol, dice)


class Sender:
    """Sends status packets on their buses with the faults that apply to them."""

    def __init__(self) -> None:
        self._glued: dict[str, Burst] = {}

    def send(self, bus: Bus, data: bytes, baud: int, fate: Fate) -> float:
        """Send a status packet; return when it ends, s."""
        put = partial(self._put, bus, data, baud, fate)
        if fate.late <= 0.0:
            return put()
        start = bus.schedule.now + fate.late
        bus.schedule.at(start, put)
        return start + len(data) * 10.0 / baud

    def _put(self, bus: Bus, data: bytes, baud: int, fate: Fate) -> float:
        """Send it now; a packet glued to it is delivered together with its last byte."""
        if fate.torn is not None:
            return self._tear(bus, data, baud, fate)
        end = bus.put(data, baud, fate.got, math.inf if fate.glued else fate.held)
        burst = bus.inbox.last
        if not fate.got or burst is None:
            return end
        waiting = self._glued.pop(bus.name, None)
        if waiting is not None and waiting.held == math.inf:
            waiting.held = end
            burst.held = max(burst.held, end)
        if fate.glued:
            self._glued[bus.name] = burst
            bus.schedule.at(end + fate.glued, partial(_release, burst, end + fate.glued))
        return end

    def _tear(self, bus: Bus, data: bytes, baud: int, fate: Fate) -> float:
        """Send it now; the adapter delivers the bytes from `torn` on later."""
        assert fate.torn is not None
        at, seconds = fate.torn
        end = bus.put(data, baud, fate.got[:at], fate.held)
        late = bus.schedule.now + seconds
        bus.inbox.append(Burst(end, 10.0 / baud, bytearray(fate.got[at:]), held=late))
        return end


def _release(burst: Burst, time: float) -> None:
    """Deliver a glued packet if no other one followed in time."""
    if burst.held == math.inf:
        burst.held = time
