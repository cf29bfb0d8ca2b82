"""A trial that is under way: an emulated robot, a program that moves it, and its guardian."""

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
"""Until a program is under way, s."""
LONGEST = 8.0
"""From an ending to motors that count as never let go, s."""
AFTERWARDS = 0.4
"""How long nothing may be driven again, and for a guardian to see that torque is off, s."""
LINES = 40
"""Of what program and guardian have printed, at most."""


class NotMeasuredError(WindupError):
    """The program was not moving its robot when it should have been ended."""


class Trial:
    """A program that moves an emulated robot, and everybody who has to do with it.

    Attributes:
        program: Its process.
        guardian: Its guardian's process number.
        planner: The process number of what plans its steps, or None.
        emulator: The process of the servos.
        journal: What became of motors, adapter and supply.
        robot: Name of the robot.
        port: Its port.
        moment: When it is ended.
        said: What the program said last.
        log: What program and guardian print.
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
        """Send a signal to "program", "guardian", "planner", "emulator" at once; return when."""
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
        """Open as many pseudo-terminals as the emulator had, which get their numbers.

        Else the next emulator would get them, and this trial's guardian would speak to a robot of
        another trial.
        """
        self.emulator.join(PATIENCE)
        self.taken += [end for _ in self.port.split(",") for end in os.openpty()]

    def press(self, number: int, times: int = 1, every: float = 0.0) -> float:
        """Send signals to the program, `every` so many s; return when the first was sent."""
        when = self.kill("program", number=number)
        for _ in range(times - 1):
            self.journal.listen(every)
            self.kill("program", number=number)
        return when

    def inject(self, faults: str) -> float:
        """Let something go wrong on the bus, and return when it was told to."""
        self.journal.pipe.send(faults)
        return time.monotonic()

    def wait_for(self, kind: str, seconds: float) -> float:
        """Return when an event of a kind came, s; at most so many s from now."""
        since, until = time.monotonic(), time.monotonic() + seconds
        while time.monotonic() < until:
            self.journal.listen(0.01)
            if found := self.journal.since(since, kind):
                return found[0].time
        raise NotMeasuredError(f"the emulator said nothing of {kind!r}")

    def hear(self, kind: str, seconds: float = PATIENCE) -> tuple[str, float]:
        """Wait until the program says something of a kind; return what, and when.

        Raises:
            NotMeasuredError: It ended, or is silent.
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

    def words(self) -> str:
        """Return the last lines that program and guardian have printed."""
        with suppress(OSError):
            if not self.log.is_file():
                return ""
            return "\n".join(self.log.read_text(errors="replace").splitlines()[-LINES:])
        return ""

    def errors(self) -> str:
        """Return what error the program has said since, if any."""
        with suppress(EOFError, OSError):
            while self._told.poll(0.0):
                self.said = str(self._told.recv()[1])
        return self.said
