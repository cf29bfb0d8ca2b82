"""One trial: an emulated robot, a program that moves it, an ending, and what follows."""

import multiprocessing
import os
import signal
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path

from hal.errors import WindupError
from tools.safety.emulated import Journal, serve
from tools.safety.processes import child_with, guardian_of
from tools.safety.program import Program, main
from tools.safety.row import Activity, Row
from tools.safety.standard_error import unread

PATIENCE = 60.0
"""Until a program is under way, s."""
LONGEST = 8.0
"""From an ending to motors that count as never let go, s."""
AFTERWARDS = 0.4
"""How long nothing may be driven again, and for a guardian to see that torque is off, s."""
# What a fresh process would import anew each time: nothing of it is kept from trial to trial.
LINES = 40
"""Of what program and guardian have printed, at most."""
PRELOAD = ["tools.robot", "tools.safety.program", "tools.safety.emulated"]


class NotMeasuredError(WindupError):
    """The program was not moving its robot when it should have been ended."""


@dataclass(frozen=True)
class Moment:
    """When a run is ended.

    Attributes:
        activity: While it is busy with this.
        after: So long after that began, s.
    """

    activity: Activity
    after: float


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
        return when

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


@contextmanager
def trial(
    name: str, row: Row, moment: Moment, arm: bool = True, faults: str = ""
) -> Iterator[Trial]:
    """Start everybody, and end everybody; `faults` go wrong on the bus from the start."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(PRELOAD)
    ours, theirs = context.Pipe()
    told, tell = context.Pipe(duplex=False)
    with tempfile.TemporaryDirectory() as folder, ExitStack() as held:
        path = None if row.network else Path(folder) / "bus"
        emulator = context.Process(target=serve, args=(name, path, theirs, faults), daemon=True)
        emulator.start()
        theirs.close()
        started: list[BaseProcess] = [emulator]
        running = None
        try:
            if not ours.poll(PATIENCE):
                raise NotMeasuredError("the emulator does not start")
            port = ours.recv()
            log = Path(folder) / "log"
            if row.errors == "unread":
                held.enter_context(unread(log))
            does = Program(name, port, moment.activity, row.fault, moment.after, arm)
            does = replace(does, errors=row.errors, log=log)
            program = context.Process(target=main, args=(does, tell), daemon=False)
            program.start()
            tell.close()
            started.append(program)
            running = Trial(emulator, Journal(ours), program, told)
            running.robot, running.port, running.moment, running.log = name, port, moment, log
            yield running
        except EOFError:
            raise NotMeasuredError("the emulator is gone") from None
        finally:
            for process in reversed(started):
                process.kill()
                process.join()
            if running is not None and running.guardian is not None:
                with suppress(ProcessLookupError):
                    os.kill(running.guardian, signal.SIGKILL)


def under_way(running: Trial) -> None:
    """Wait until the program is busy with what it is ended in, and for the moment to end it.

    Raises:
        NotMeasuredError: It is not.
    """
    running.hear("doing")
    assert running.program.pid is not None
    running.guardian = guardian_of(running.port)
    running.planner = child_with(running.program.pid, "plan_worker")
    if not running.journal.wait_until_still(1.0, still=False):
        raise NotMeasuredError("no motor is driven though the run has begun")
