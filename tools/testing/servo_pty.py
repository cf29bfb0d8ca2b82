"""Emulated servos on a pseudo-terminal, for programs that open a path.

with ServoPty(servos="STS3215:1-6") as pty:
    subprocess.run(["my_program", "--port", pty.path], check=True)
    assert pty.driven() == 0  # the program has switched torque off
"""

import json
import select
import subprocess
import sys
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Self, Unpack

from windup.hal.errors import PortError, UsageError
from windup.sim_twin.wire.faults.fault_methods import FaultMethods
from windup.sim_twin.wire.faults.fault_rule import FaultRule
from windup.sim_twin.wire.faults.fault_text import format_rule
from windup.sim_twin.wire.world.address import BENCH
from windup.tools.testing.bus_options import BusOptions, bus_url

SERVER = "windup.tools.testing.pty_server"
PATIENCE = 60.0
"""Longest time to wait for an answer of the emulator, s."""
END = 10.0
"""Longest time to wait for its end before it is killed, s."""


class PtyFaults(FaultMethods):
    """The faults of a `ServoPty`; times (`at`) count from the call, s.

    Args:
        inject: Adds a fault, given as text.
        clear: Removes all faults.
    """

    def __init__(self, inject: Callable[[str], object], clear: Callable[[], object]) -> None:
        self._inject, self._clear = inject, clear

    @property
    def now(self) -> float:
        """The present time, s: 0, since times count from the call."""
        return 0.0

    def add(self, rule: FaultRule) -> Self:
        """Add a fault.

        Raises:
            UsageError: It refers to a bus, servos or an IMU that are not there.
        """
        self._inject(format_rule(rule))
        return self

    def clear(self) -> Self:
        """Remove all faults; devices that are broken already stay broken."""
        self._clear()
        return self


class ServoPty:
    """Emulated buses on pseudo-terminals, served in real time by a separate process.

    This is for programs that open a path. If a test can pass an open port to the program, use
    `ServoBus`: its time is virtual, and every run exchanges the same bytes.

    Args:
        robot: Name of a robot, path of its folder, or "bench" for `servos` without a robot.
        path: Path of the pseudo-terminal, to which the bus name is appended if there are several
            buses; by default in a new temporary folder.
        **options: Servos, baud rate, latency, supply, faults, seed: see `BusOptions`.

    Attributes:
        path: Path of the first bus.
        paths: Paths by bus name.
        faults: The faults, one method for each kind.

    Raises:
        UsageError: An option is not possible, or the path exists already.
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
            bufsize=0,  # what `select` calls ready is all that has not been read
            start_new_session=True,  # Ctrl-C is sent to the test only
        )
        self.faults = PtyFaults(
            lambda text: self._ask({"inject": text}), lambda: self._ask({"clear": True})
        )
        self._orders = 0
        try:
            self.paths: dict[str, str] = self._hear()["paths"]
        except BaseException:
            self.close()
            raise
        self.path = next(iter(self.paths.values()))

    def driven(self) -> int:
        """Return the number of motors that are driven now; 0 after a program that ended safely."""
        return int(self._ask({"driven": True})["driven"])

    def close(self) -> None:
        """End the process and remove its paths; a second call has no effect."""
        stdin, stdout = self._process.stdin, self._process.stdout
        assert stdin is not None and stdout is not None
        with ExitStack() as stack:
            if self._folder is not None:
                stack.callback(self._folder.cleanup)
            stack.callback(stdout.close)
            with suppress(BrokenPipeError):  # an order that the dead process has not read
                stdin.close()
            try:
                self._process.wait(END)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()

    def _ask(self, order: dict[str, Any]) -> dict[str, Any]:
        """Send an order and return the answer; see `_hear`."""
        stdin = self._process.stdin
        if stdin is None or stdin.closed:
            raise UsageError("these servos are closed; open them again with servo_pty(...)")
        self._orders += 1
        with suppress(BrokenPipeError):  # the answer says that the process has ended
            stdin.write(json.dumps(order | {"number": self._orders}).encode() + b"\n")
        return self._hear()

    def _hear(self) -> dict[str, Any]:
        """Return the answer to the last order; late answers to earlier ones are left out.

        Raises:
            UsageError: The order is not possible.
            PortError: The process has ended or does not answer.
        """
        answer = self._line()
        while answer.get("number", self._orders) != self._orders:
            answer = self._line()
        if "error" in answer:
            raise UsageError(answer["error"])
        return answer

    def _line(self) -> dict[str, Any]:
        """Return the next line of the process; see `_hear`."""
        stdout = self._process.stdout
        assert stdout is not None
        ready, _, _ = select.select([stdout], [], [], PATIENCE)
        line = stdout.readline() if ready else b""
        if not line:
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(END if ready else 0.0)  # it ends soon after its output
            raise PortError(f"the process that emulates these servos {self._silence()}")
        answer: dict[str, Any] = json.loads(line)
        return answer

    def _silence(self) -> str:
        """Return why there is no answer."""
        status = self._process.poll()
        if status is None:
            return f"runs, and has not answered for {PATIENCE:g} s; is the machine busy?"
        return f"has ended (exit status {status}); see its output"

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
