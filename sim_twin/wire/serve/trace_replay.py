"""A world that answers from a trace, without servos or physics, and checks the host's bytes."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from windup.sim_twin.wire.bus.bus import BITS, Bus
from windup.sim_twin.wire.bus.inbox import Burst
from windup.sim_twin.wire.bus.parsed_item import ParsedItem
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.schedule import Schedule
from windup.sim_twin.wire.serve.trace import (
    FROM_HOST,
    TO_HOST,
    TraceError,
    TraceLine,
    difference,
    read_trace,
)
from windup.sim_twin.wire.shafts.shaft import InertiaShaft
from windup.sim_twin.wire.world.bus_world import BenchPhysics, BusWorld


@dataclass
class TraceReplay:
    """The protocol of a bus that answers from a trace.

    Attributes:
        path: The trace.
        lines: Its lines for this bus.
    """

    path: Path
    lines: list[TraceLine]
    bus: Bus = field(init=False, repr=False)
    id_at: int = 0
    length_at: int = 0
    data_at: int = 0
    tail: int = 1
    _at: int = 0

    def with_checksum(self, frame: bytes) -> bytes:
        """Return `frame` unchanged."""
        return frame

    def set_devices(self, devices: Sequence[Device]) -> None:
        """Do nothing: there are no devices."""

    def feed(self, chunk: bytes) -> list[ParsedItem]:
        """Compare the host's bytes with the trace, and schedule the recorded answer."""
        bus, lines = self.bus, self.lines
        wanted = lines[self._at] if self._at < len(lines) else None
        got = TraceLine(bus.began, bus.name, FROM_HOST, bus.baud, 0.0, chunk)
        if wanted is None or not wanted.matches(got):
            raise TraceError(difference(self.path, lines, self._at, got))
        self._at += 1
        self.answer()
        return []

    def answer(self) -> None:
        """Schedule the recorded bytes up to the host's next ones."""
        while self._at < len(self.lines) and self.lines[self._at].direction == TO_HOST:
            line = self.lines[self._at]
            burst = Burst(
                line.time, BITS / line.baud, bytearray(line.data), held_until=line.held_until
            )
            self.bus.schedule.add(line.time, partial(self.bus.inbox.append, burst))
            self._at += 1

    def reset(self) -> None:
        """Do nothing: there is no partial frame."""

    def execute(self, frame: ParsedItem, bus: Bus) -> bool:
        """Do nothing; return False."""
        return False

    def finish(self) -> None:
        """Check that the whole trace has been played.

        Raises:
            TraceError: The host stopped before the trace ends.
        """
        if self._at < len(self.lines):
            raise TraceError(difference(self.path, self.lines, self._at, None))


def replay_world(path: Path) -> BusWorld:
    """Return a world that answers from a trace and raises a `TraceError` at a wrong byte."""
    lines = read_trace(path)
    schedule, buses = Schedule(), {}
    for name in dict.fromkeys(line.bus for line in lines):
        mine = [line for line in lines if line.bus == name]
        replay = TraceReplay(path, mine)
        replay.bus = buses[name] = Bus(name, [], replay, schedule, mine[0].baud)
        replay.answer()
    nothing: list[InertiaShaft] = []
    return BusWorld(BenchPhysics(nothing), schedule, buses)


def check_played(world: BusWorld) -> None:
    """Check that the traces of all buses of a world have been played.

    Raises:
        TraceError: The host stopped before a trace ends.
    """
    for bus in world.buses.values():
        if isinstance(bus.protocol, TraceReplay):
            bus.protocol.finish()
