"""An emulated robot in a process of its own, which applies faults and timestamps events."""

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
"""Real-time priority of an emulator: above all programs, so that none delays servos and physics."""


def serve(name: str, path: Path | None, pipe: Connection, faults: str = "") -> None:
    """Serve a robot for ever; the main function of the process.

    Args:
        name: The robot.
        path: Path of the pseudo-terminal; None for a TCP port.
        pipe: Sends the port's URL, then every `Event`; receives faults to inject.
        faults: Faults that are active from the start.
    """

    def ready(emulator: Emulator) -> None:
        pipe.send(port_of(emulator))
        threading.Thread(target=_inject, args=(emulator, pipe), daemon=True).start()

    with suppress(OSError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(FIRST))
    address = parse_address(f"twin://{name}?clock=real&faults={faults}")
    emulate(address, path, None if path else 0, on_ready=ready, events=pipe.send)


def port_of(emulator: Emulator) -> str:
    """Return the value of `--port` for the buses of an emulator."""
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
    """The events of motors, adapters and supply that an emulator has reported.

    Attributes:
        pipe: Connection to the emulator.
        events: Events received so far, in order.
    """

    pipe: Connection
    events: list[Event] = field(default_factory=list)

    @property
    def driven(self) -> int:
        """Number of driven motors according to the last event."""
        return next((int(e.value) for e in reversed(self.events) if e.kind == "driven"), 0)

    def listen(self, seconds: float) -> None:
        """Receive events for `seconds`; return early if the emulator has ended."""
        until = time.monotonic() + seconds
        try:
            while self.pipe.poll(max(until - time.monotonic(), 0.0)):
                self.events.append(self.pipe.recv())
        except (EOFError, OSError):
            return

    def wait_until_still(self, seconds: float, still: bool = True) -> bool:
        """Wait until no motor is driven (or one is); return whether that happened in `seconds`."""
        until = time.monotonic() + seconds
        while (self.driven == 0) is not still:
            if (left := until - time.monotonic()) <= 0.0:
                return False
            self.listen(min(left, 0.02))
        return True

    def since(self, time_: float, *kinds: str) -> list[Event]:
        """Return the events of some kinds since `time_`, s on the monotonic clock."""
        return [event for event in self.events if event.time >= time_ and event.kind in kinds]
