"""Traces: every byte on the buses of a world, with direction and virtual time, as a text file.

One burst per line: ``time bus direction baud held bytes``; ">" is from the host, "<" to the host,
and `held` is when an adapter delivered the bytes, "-" for without delay. Times in s. Traces are
meant to be kept with tests: `Recorder` writes one, `Checker` compares a run with one.
"""

from collections import deque
from functools import partial
from pathlib import Path
from typing import NamedTuple

from windup.sim_twin.wire.bus.inbox import Burst
from windup.sim_twin.wire.world.bus_world import BusWorld

HEADER = "# windup trace 1: time s, bus, direction, baud, held s, bytes"
SAME_TIME = 1e-6  # s
CONTEXT = 3  # lines shown before a difference
LAG = 8  # number of later bursts after which a burst does not change any more
TO_HOST, FROM_HOST = "<", ">"


class TraceError(AssertionError):
    """A run differs from a trace, or a file is not a trace."""


class TraceLine(NamedTuple):
    """One burst of a trace; see the module's docstring."""

    time: float
    bus: str
    direction: str
    baud: int
    held_until: float
    data: bytes

    def __str__(self) -> str:
        held = f"{self.held_until:.9f}" if self.held_until else "-"
        return (
            f"{self.time:.9f} {self.bus} {self.direction} {self.baud} {held} {self.data.hex(' ')}"
        )

    def matches(self, other: "TraceLine") -> bool:
        """Return whether the other line is the same burst at the same time."""
        return (
            self[1:4] == other[1:4]
            and self.data == other.data
            and abs(self.time - other.time) < SAME_TIME
            and abs(self.held_until - other.held_until) < SAME_TIME
        )


def read_trace(path: Path) -> list[TraceLine]:
    """Return the lines of a trace.

    Raises:
        TraceError: The file is not a trace.
    """
    text = path.read_text(encoding="utf-8").splitlines()
    if not text or text[0] != HEADER:
        raise TraceError(f"{path} is no trace: its first line should be {HEADER!r}")
    return [_parse(line) for line in text[1:] if line]


def _parse(line: str) -> TraceLine:
    time, bus, direction, baud, held, *data = line.split(" ")
    late = 0.0 if held == "-" else float(held)
    return TraceLine(float(time), bus, direction, int(baud), late, bytes.fromhex("".join(data)))


class Tap:
    """Receives the bursts on all buses of a world.

    Collisions and adapters change a burst after its start, so it is reported a few bursts later.
    """

    def __init__(self, world: BusWorld) -> None:
        self._world = world
        self._pending: deque[tuple[str, str, int, Burst]] = deque()
        for bus in world.buses.values():
            if bus.tap is not None:
                raise TraceError(f"bus {bus.name!r} is being recorded or checked already")
        for bus in world.buses.values():
            bus.tap = partial(self._receive, bus.name)

    def handle(self, line: TraceLine) -> None:
        """Process a burst that is complete."""
        raise NotImplementedError

    def close(self) -> None:
        """Process the pending bursts and detach from the buses."""
        for bus in self._world.buses.values():
            bus.tap = None
        while self._pending:
            self._take()

    def _receive(self, bus: str, direction: str, baud: int, burst: Burst) -> None:
        self._pending.append((bus, direction, baud, burst))
        if len(self._pending) > LAG:
            self._take()

    def _take(self) -> None:
        bus, direction, baud, burst = self._pending.popleft()
        self.handle(
            TraceLine(burst.start, bus, direction, baud, burst.held_until, bytes(burst.data))
        )


class Recorder(Tap):
    """Writes a trace; it is complete after `close`."""

    def __init__(self, world: BusWorld, path: Path) -> None:
        super().__init__(world)
        self._file = path.open("w", encoding="utf-8")
        self._file.write(HEADER + "\n")

    def handle(self, line: TraceLine) -> None:
        """Write a burst."""
        self._file.write(f"{line}\n")

    def close(self) -> None:
        """Detach from the buses and close the file."""
        try:
            super().close()
        finally:
            self._file.close()


class Checker(Tap):
    """Compares a run with a trace, and raises a `TraceError` at the first difference."""

    def __init__(self, world: BusWorld, path: Path) -> None:
        super().__init__(world)
        self.path, self._lines, self._at = path, read_trace(path), 0

    def handle(self, line: TraceLine) -> None:
        """Compare a burst with the next line of the trace."""
        wanted = self._lines[self._at] if self._at < len(self._lines) else None
        if wanted is None or not wanted.matches(line):
            raise TraceError(difference(self.path, self._lines, self._at, line))
        self._at += 1

    def close(self) -> None:
        """Detach from the buses; lines of the trace that are left over are a difference too."""
        super().close()
        if self._at < len(self._lines):
            raise TraceError(difference(self.path, self._lines, self._at, None))


def difference(path: Path, lines: list[TraceLine], at: int, got: TraceLine | None) -> str:
    """Return a description of how `got` differs from line `at` of a trace."""
    wanted = lines[at] if at < len(lines) else None
    text = [f"{path}, line {at + 2}: {_first_difference(wanted, got)}"]
    text += [f"  {line}" for line in lines[max(0, at - CONTEXT) : at]]
    text.append(f"- {wanted}" if wanted else "- (the trace ends)")
    text.append(f"+ {got}" if got else "+ (no further bytes)")
    if wanted and got and wanted.data != got.data:
        before = str(wanted)[: -len(wanted.data.hex(" "))]
        text.append(" " * (2 + len(before) + 3 * _place(wanted.data, got.data)) + "^^")
    return "\n".join(text)


def _first_difference(wanted: TraceLine | None, got: TraceLine | None) -> str:
    if wanted is None or got is None:
        return f"{'more' if wanted is None else 'fewer'} bytes than recorded"
    for name in ("bus", "direction", "baud"):
        if getattr(wanted, name) != getattr(got, name):
            return f"{name} {getattr(got, name)!r}, recorded {getattr(wanted, name)!r}"
    if wanted.data != got.data:
        return f"byte {_place(wanted.data, got.data)} of {len(wanted.data)} differs"
    return f"{(got.time - wanted.time) * 1e6:+.1f} us"


def _place(one: bytes, other: bytes) -> int:
    pairs = enumerate(zip(one, other, strict=False))
    return next((k for k, (a, b) in pairs if a != b), min(len(one), len(other)))
