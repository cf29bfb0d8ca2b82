"""A trial in progress: an emulated robot, a program that moves it, and its guardian."""

import os
import signal
import time
from contextlib import suppress
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path

from windup.hal.errors import WindupError
from windup.tools.benches.safety.emulated import Journal
from windup.tools.benches.safety.moment import Moment

PATIENCE = 60.0
"""Longest time until a program is under way, s."""
LONGEST = 8.0
"""Time from an ending after which motors count as never switched off, s."""
AFTERWARDS = 0.4
"""Time in which no motor may be driven again, and a guardian may see that torque is off, s."""
LINES = 40
"""Largest number of lines of the log that are shown."""


class NotMeasuredError(WindupError):
    """The program was not moving its robot when it should have been ended."""


class Trial:
    """A program that moves an emulated robot, and all related processes.

    Attributes:
        program: Process of the program.
        guardian: Process id of its guardian, or None.
        planner: Process id of its step planner, or None.
        emulator: Process of the emulated servos.
        journal: Events of motors, adapter and supply.
        robot: Name of the robot.
        port: Its port.
        moment: The moment at which the run is ended.
        said: Last message of the program.
        log: Output of program and guardian.
        taken: Descriptors to close afterwards.
    """

    def __init__(
        self, emulator: BaseProcess, journal: Journal, program: BaseProcess, told: Connection
    ) -> None:
        self.emulator, self.journal, self.program, self._told = emulator, journal, program, told
        self.robot = self.port = ""
        self.said = ""
        self.moment = Moment("standing", 0.0)
        self.log = Path(os.devnull)
        self.guardian: int | None = None
        self.planner: int | None = None
        self.taken: list[int] = []

    def kill(self, *who: str, number: int = signal.SIGKILL) -> float:
        """Send a signal to "program", "guardian", "planner", "emulator"; return the time, s."""
        pids = {
            "program": self.program.pid,
            "emulator": self.emulator.pid,
            "guardian": self.guardian,
            "planner": self.planner,
        }
        when = time.monotonic()
        for each in who:
            pid = pids[each]
            if pid is not None:
                with suppress(ProcessLookupError):
                    os.kill(pid, number)
        if "emulator" in who and number == signal.SIGKILL:
            self._take_its_terminals()
        return when

    def _take_its_terminals(self) -> None:
        """Open as many pseudo-terminals as the emulator had, to occupy their numbers.

        Otherwise the next emulator would get them, and this trial's guardian would control the
        robot of another trial.
        """
        self.emulator.join(PATIENCE)
        self.taken += [end for _ in self.port.split(",") for end in os.openpty()]

    def press(self, number: int, times: int = 1, every: float = 0.0) -> float:
        """Send `times` signals to the program at intervals of `every` s; return the first time."""
        when = self.kill("program", number=number)
        for _ in range(times - 1):
            self.journal.listen(every)
            self.kill("program", number=number)
        return when

    def inject(self, faults: str) -> float:
        """Inject faults into the bus; return the time at which they were sent, s."""
        self.journal.pipe.send(faults)
        return time.monotonic()

    def wait_for(self, kind: str, seconds: float) -> float:
        """Return the time of the next event of a kind, s; wait for `seconds` at most."""
        since, until = time.monotonic(), time.monotonic() + seconds
        while time.monotonic() < until:
            self.journal.listen(0.01)
            if found := self.journal.since(since, kind):
                return found[0].time
        raise NotMeasuredError(f"the emulator said nothing of {kind!r}")

    def wait_for_message(self, kind: str, seconds: float = PATIENCE) -> tuple[str, float]:
        """Wait for a message of a kind from the program; return its content and time, s.

        Raises:
            NotMeasuredError: The program ended, or sent no such message in time.
        """
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0.0:
            if not self._told.poll(min(left, 0.05)):
                if not self.program.is_alive() and not self._told.poll(0.0):
                    raise NotMeasuredError(f"the program ended by itself {self.said}")
                continue
            try:
                heard, what = self._told.recv()
            except EOFError:
                raise NotMeasuredError(f"the program is gone {self.said}") from None
            if heard == kind:
                return str(what), float(what) if kind == "fault" else time.monotonic()
            self.said = f"({what})"
        raise NotMeasuredError(f"the program did not get so far in {seconds:g} s")

    def last_lines(self) -> str:
        """Return the last lines that program and guardian have printed."""
        with suppress(OSError):
            if not self.log.is_file():
                return ""
            return "\n".join(self.log.read_text(errors="replace").splitlines()[-LINES:])
        return ""

    def errors(self) -> str:
        """Return the last message of the program, such as its error, or ""."""
        with suppress(EOFError, OSError):
            while self._told.poll(0.0):
                self.said = str(self._told.recv()[1])
        return self.said
