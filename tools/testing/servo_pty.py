"""Emulated servos for programs that open a path: a process that lives as long as a test.

with ServoPty(servos="STS3215:1-6") as pty:
    subprocess.run(["my_program", "--port", pty.path], check=True)
    assert pty.driven() == 0  # it has let go
"""

import json
import select
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Self, Unpack

from windup.hal.errors import PortError, UsageError
from windup.sim_twin.wire.faults.fault_methods import FaultMethods
from windup.sim_twin.wire.faults.fault_rule import Rule
from windup.sim_twin.wire.faults.fault_text import format_rule
from windup.sim_twin.wire.world.address import BENCH
from windup.tools.testing.bus_options import BusOptions, bus_url

SERVER = "windup.tools.testing.pty_server"
PATIENCE = 60.0
"""How long an answer of the emulator may take on a busy machine, s."""
END = 10.0
"""How long it may take to end, s."""


class PtyFaults(FaultMethods):
    """What goes wrong from now on in a process that serves; `at` counts from now, s.

    Args:
        inject: Takes a fault as text.
        clear: Lets nothing go wrong any more.
    """

    def __init__(self, inject: Callable[[str], object], clear: Callable[[], object]) -> None:
        self._inject, self._clear = inject, clear

    @property
    def now(self) -> float:
        """Times count from the call, s."""
        return 0.0

    def add(self, rule: Rule) -> Self:
        """Add a fault.

        Raises:
            UsageError: It cannot happen on these buses.
        """
        self._inject(format_rule(rule))
        return self

    def clear(self) -> Self:
        """Let nothing go wrong any more; what is broken stays broken."""
        self._clear()
        return self


class ServoPty:
    """Emulated buses on pseudo-terminals, in a process of their own, in real time.

    For programs that open a path. Where a test can hand over a port instead, `ServoBus` is the
    better choice: there time is virtual, and every run brings the same bytes.

    Args:
        robot: Name of a robot, path of a folder with one, or "bench": `servos` alone.
        path: Where the pseudo-terminal is to be found (several buses: with their name behind it);
            in a new folder by default.
        **options: Servos, baud rate, latency, supply, faults, seed: see `BusOptions`.

    Attributes:
        path: What a program opens; with several buses, that of the first.
        paths: Name of the bus to the path.
        faults: What goes wrong, one method for each kind of fault.

    Raises:
        UsageError: An option cannot be, or something is at the path already.
    """

    def __init__(
        self,
        robot: str | Path = BENCH,
        *,
        path: str | Path | None = None,
        **options: Unpack[BusOptions],
    ) -> None:
        url = bus_url(robot, options)
        self._folder = TemporaryDirectory(prefix="windup-") if path is None else None
        place = Path(self._folder.name, "bus") if self._folder else Path(path or "")
        self._process = subprocess.Popen(
            [sys.executable, "-m", SERVER, url, str(place)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            start_new_session=True,  # Ctrl-C is for the test
        )
        self.faults = PtyFaults(
            lambda text: self._ask({"inject": text}), lambda: self._ask({"clear": True})
        )
        try:
            self.paths: dict[str, str] = self._hear()["paths"]
        except BaseException:
            self.close()
            raise
        self.path = next(iter(self.paths.values()))

    def driven(self) -> int:
        """Return how many motors are driven now: 0 is what a program should leave behind."""
        return int(self._ask({"driven": True})["driven"])

    def close(self) -> None:
        """End the process and take its paths away. Closing twice is no error."""
        stdin, stdout = self._process.stdin, self._process.stdout
        assert stdin is not None and stdout is not None
        stdin.close()
        try:
            self._process.wait(END)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        stdout.close()
        if self._folder is not None:
            self._folder.cleanup()

    def _ask(self, order: dict[str, Any]) -> dict[str, Any]:
        """Send an order and return the answer."""
        stdin = self._process.stdin
        if stdin is None or stdin.closed:
            raise UsageError("these servos are closed; nothing can be asked of them any more")
        stdin.write(json.dumps(order) + "\n")
        stdin.flush()
        return self._hear()

    def _hear(self) -> dict[str, Any]:
        """Return the next answer.

        Raises:
            UsageError: The order cannot be carried out.
            PortError: The process has ended, or is silent.
        """
        stdout = self._process.stdout
        assert stdout is not None
        ready, _, _ = select.select([stdout], [], [], PATIENCE)
        line = stdout.readline() if ready else ""
        if not line:
            raise PortError("the process that emulates these servos has ended; see its last words")
        answer: dict[str, Any] = json.loads(line)
        if "error" in answer:
            raise UsageError(answer["error"])
        return answer

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
