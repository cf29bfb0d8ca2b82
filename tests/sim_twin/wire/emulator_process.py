"""An emulator in its own process, for the tests of programs that are not ours."""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

SCRIPT = """
import signal, sys
from pathlib import Path
from sim_twin.wire import parse_address
from sim_twin.wire.emulate import Emulator, emulate

def ready(emulator: Emulator) -> None:
    signal.signal(signal.SIGTERM, lambda *_: emulator.stop())
    print(emulator.outlets[0].name, flush=True)

pty = Path(sys.argv[2]) if len(sys.argv) > 2 else None
emulate(parse_address(sys.argv[1]), pty=pty, tcp=None if pty else 0, on_ready=ready)
"""


@contextmanager
def emulator(url: str, pty: Path | None = None) -> Iterator[str]:
    """Serve a world; the value is what a program has to open."""
    arguments = [sys.executable, "-c", SCRIPT, url, *([str(pty)] if pty else [])]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            yield process.stdout.readline().strip()
        finally:
            process.terminate()
            assert process.wait(10) == 0
