"""An emulator in its own process, for the tests of programs that are not ours."""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

SCRIPT = """
import signal, sys, threading
from pathlib import Path
from windup.sim_twin.wire import parse_address
from windup.sim_twin.wire.serve.emulate import Emulator, emulate

def ready(emulator: Emulator) -> None:
    signal.signal(signal.SIGTERM, lambda *_: emulator.stop())
    print(emulator.outlets[0].name, flush=True)
    threading.Thread(target=listen, args=(emulator,), daemon=True).start()

def listen(emulator: Emulator) -> None:
    for line in sys.stdin:
        emulator.inject(line.strip())

def tell(event) -> None:
    print(event.kind, event.value, event.bus, flush=True)

pty = Path(sys.argv[2]) if len(sys.argv) > 2 else None
emulate(
    parse_address(sys.argv[1]), pty=pty, tcp=None if pty else 0, on_ready=ready, events=tell
)
"""


@dataclass
class EmulatorProcess:
    """A running emulator.

    Attributes:
        name: What a program has to open.
        orders: Takes faults to inject, one text a line.
        events: Gives the events, one a line: kind, value, bus.
    """

    name: str
    orders: IO[str]
    events: IO[str]

    def inject(self, text: str) -> None:
        print(text, file=self.orders, flush=True)

    def next_event(self) -> str:
        """Wait for an event."""
        return self.events.readline().strip()


@contextmanager
def run_emulator(url: str, pty: Path | None = None) -> Iterator[EmulatorProcess]:
    """Serve a world in a process that takes orders."""
    arguments = [sys.executable, "-c", SCRIPT, url, *([str(pty)] if pty else [])]
    pipe = subprocess.PIPE
    with subprocess.Popen(arguments, stdin=pipe, stdout=pipe, text=True) as process:
        try:
            assert process.stdin is not None and process.stdout is not None
            name = process.stdout.readline().strip()
            yield EmulatorProcess(name, process.stdin, process.stdout)
        finally:
            process.terminate()
            assert process.wait(10) == 0


@contextmanager
def emulator(url: str, pty: Path | None = None) -> Iterator[str]:
    """Serve a world; the value is what a program has to open."""
    with run_emulator(url, pty) as process:
        yield process.name
