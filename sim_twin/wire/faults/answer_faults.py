"""What goes wrong with an answer on its way from a device to the host."""

import math
import random
from dataclasses import dataclass
from functools import partial

from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.bus.inbox import Burst
from windup.sim_twin.wire.bus.spoilt import spoil


@dataclass
class Fate:
    """What becomes of one answer.

    Attributes:
        got: What the host gets of it.
        before: The device's last answer of this length.
        late: By how much it leaves the device later, s.
        held: Until when the adapter holds it back, s.
        glued: How long at most it waits for the next one, s.
        torn: From which byte on the adapter holds it back, and for how long, s.
    """

    got: bytes
    before: bytes = b""
    late: float = 0.0
    held: float = 0.0
    glued: float = 0.0
    torn: tuple[int, float] | None = None

    def suffer(self, kind: str, seconds: float, bus: Bus, dice: random.Random) -> None:
        """Have one fault of `fault_rule.ANSWERS` done to it."""
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
            self.got = spoil(kind, self.got, bus.language, dice)


class Sender:
    """Puts answers on their buses as their fate has it."""

    def __init__(self) -> None:
        self._glued: dict[str, Burst] = {}

    def send(self, bus: Bus, data: bytes, baud: int, fate: Fate) -> float:
        """Put an answer on the wire; return when it ends, s."""
        put = partial(self._put, bus, data, baud, fate)
        if fate.late <= 0.0:
            return put()
        start = bus.schedule.now + fate.late
        bus.schedule.at(start, put)
        return start + len(data) * 10.0 / baud

    def _put(self, bus: Bus, data: bytes, baud: int, fate: Fate) -> float:
        """Put it there; one that was glued to it comes with its last byte."""
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
        """Put it there, and what the adapter holds back of it behind it."""
        assert fate.torn is not None
        at, seconds = fate.torn
        end = bus.put(data, baud, fate.got[:at], fate.held)
        late = bus.schedule.now + seconds
        bus.inbox.append(Burst(end, 10.0 / baud, bytearray(fate.got[at:]), held=late))
        return end


def _release(burst: Burst, time: float) -> None:
    """Stop waiting for an answer to glue to."""
    if burst.held == math.inf:
        burst.held = time
