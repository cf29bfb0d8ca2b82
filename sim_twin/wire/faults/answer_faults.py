"""Faults that hit a status packet between a device and the host."""

import math
import random
from dataclasses import dataclass
from functools import partial

from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.bus.corruption import corrupt_packet
from windup.sim_twin.wire.bus.inbox import Burst


@dataclass
class PacketFaults:
    """The faults that apply to one status packet.

    Attributes:
        received: The bytes that the host receives.
        before: The device's previous status packet of the same length.
        late: Additional delay before the device sends it, s.
        held_until: Time until which the adapter holds it back, s.
        glue_time: Longest time for which the adapter waits to deliver it with the next one, s.
        late_from: Index of the first byte that the adapter holds back, and for how long, s.
    """

    received: bytes
    before: bytes = b""
    late: float = 0.0
    held_until: float = 0.0
    glue_time: float = 0.0
    late_from: tuple[int, float] | None = None

    def apply(self, kind: str, seconds: float, bus: Bus, rng: random.Random) -> None:
        """Apply one fault of `fault_rule.ANSWERS`."""
        if kind == "late":
            self.late += seconds
        elif kind == "delay":
            self.held_until = max(self.held_until, bus.schedule.now + seconds)
        elif kind == "glue":
            self.glue_time = seconds
        elif kind == "late_byte":
            self.late_from = rng.randrange(len(self.received)), seconds
        elif kind == "stale":
            self.received = self.before
        else:
            self.received = corrupt_packet(kind, self.received, bus.protocol, rng)


class Sender:
    """Sends status packets on their buses with the faults that apply to them."""

    def __init__(self) -> None:
        self._glued: dict[str, Burst] = {}

    def send(self, bus: Bus, data: bytes, baud: int, faults: PacketFaults) -> float:
        """Send a status packet; return when it ends, s."""
        put = partial(self._put, bus, data, baud, faults)
        if faults.late <= 0.0:
            return put()
        start = bus.schedule.now + faults.late
        bus.schedule.add(start, put)
        return start + len(data) * 10.0 / baud

    def _put(self, bus: Bus, data: bytes, baud: int, faults: PacketFaults) -> float:
        """Send it now; a packet glued to it is delivered together with its last byte."""
        if faults.late_from is not None:
            return self._tear(bus, data, baud, faults)
        end = bus.put(
            data, baud, faults.received, math.inf if faults.glue_time else faults.held_until
        )
        burst = bus.inbox.last
        if not faults.received or burst is None:
            return end
        waiting = self._glued.pop(bus.name, None)
        if waiting is not None and waiting.held_until == math.inf:
            waiting.held_until = end
            burst.held_until = max(burst.held_until, end)
        if faults.glue_time:
            self._glued[bus.name] = burst
            bus.schedule.add(
                end + faults.glue_time, partial(_release, burst, end + faults.glue_time)
            )
        return end

    def _tear(self, bus: Bus, data: bytes, baud: int, faults: PacketFaults) -> float:
        """Send it now; the adapter delivers the bytes from `late_from` on later."""
        assert faults.late_from is not None
        at, seconds = faults.late_from
        end = bus.put(data, baud, faults.received[:at], faults.held_until)
        late = bus.schedule.now + seconds
        bus.inbox.append(Burst(end, 10.0 / baud, bytearray(faults.received[at:]), held_until=late))
        return end


def _release(burst: Burst, time: float) -> None:
    """Deliver a glued packet if no other one followed in time."""
    if burst.held_until == math.inf:
        burst.held_until = time
