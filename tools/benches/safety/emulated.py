"""An emulated robot in a process of its own, that takes faults and dates what becomes of it."""

import os
import threading
import time
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path

from windup.hal.clock import PRIORITY
from windup.sim_twin.wire import parse_address
from windup.sim_twin.wire.serve.emulate import Emulator, emulate
from windup.sim_twin.wire.serve.journal import Event

FIRST = PRIORITY + 10
"""Of an emulator among real-time processes: servos and physics wait for no program."""


def serve(name: str, path: Path | None, pipe: Connection, faults: str = "") -> None:
    """Serve a robot for ever; the body of the process.

    Args:
        name: The robot.
        path: Of the pseudo-terminal; None for a TCP port.
        pipe: Sends the port's URL, then every `Event`; takes faults to inject.
        faults: What goes wrong from the start.
    """

    def ready(emulator: Emulator) -> None:
        pipe.send(port_of(emulator))
        threading.Thread(target=_inject, args=(emulator, pipe), daemon=True).start()

    with suppress(OSError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(FIRST))
    address = parse_address(f"twin://{name}?clock=real&faults={faults}")
    emulate(address, path, None if path else 0, on_ready=ready, events=pipe.send)


def port_of(emulator: Emulator) -> str:
    """Return what `--port` takes for the buses of an emulator."""
    if len(emulator.outlets) == 1:
        return emulator.outlets[0].name
    return ",".join(f"{outlet.bus.name}={outlet.name}" for outlet in emulator.outlets)


def _inject(emulator: Emulator, pipe: Connection) -> None:
    while True:
        try:
            emulator.inject(pipe.recv())
        except (EOFError, OSError):
            return


@dataclass
class Journal:
    """What an emulator has said about motors, adapters and supply, as it comes.

    Attributes:
        pipe: Where it says so.
        events: What it has said, in order.
    """

    pipe: Connection
    events: list[Event] = field(default_factory=list)

    @property
    def driven(self) -> int:
        """How many motors are driven, as far as is known."""
        return next((int(e.value) for e in reversed(self.events) if e.kind == "driven"), 0)

    def listen(self, seconds: float) -> None:
        """Take in what comes within some time, s; an emulator that is gone says nothing more."""
        until = time.monotonic() + seconds
        try:
            while self.pipe.poll(max(until - time.monotonic(), 0.0)):
                self.events.append(self.pipe.recv())
        except (EOFError, OSError):
            return

    def wait_until_still(self, seconds: float, still: bool = True) -> bool:
        """Wait until no motor is driven (or one is); return whether that came in time, s."""
        until = time.monotonic() + seconds
        while (self.driven == 0) is not still:
            if (left := until - time.monotonic()) <= 0.0:
                return False
            self.listen(min(left, 0.02))
        return True

    def since(self, time_: float, *kinds: str) -> list[Event]:
        """Return the events of some kinds after a moment, s on the monotonic clock."""
        return [event for event in self.events if event.time >= time_ and event.kind in kinds]
