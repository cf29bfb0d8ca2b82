"""Starts an emulated robot and a program that moves it, and always ends both."""

import multiprocessing
import os
import signal
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from multiprocessing.process import BaseProcess
from pathlib import Path

from windup.tools.benches.safety.emulated import Journal, serve
from windup.tools.benches.safety.moment import Moment
from windup.tools.benches.safety.processes import alive, child_with, guardian_of, is_guardian
from windup.tools.benches.safety.program import Program, main
from windup.tools.benches.safety.row import Ending
from windup.tools.benches.safety.standard_error import unread
from windup.tools.benches.safety.trial import PATIENCE, NotMeasuredError, Trial

PRELOAD = [
    "windup.tools.robot.motions",
    "windup.tools.benches.safety.program",
    "windup.tools.benches.safety.emulated",
]
"""Modules to import once for all trials; no other state is shared between them."""


@contextmanager
def trial(
    name: str, row: Ending, moment: Moment, arm: bool = True, faults: str = ""
) -> Iterator[Trial]:
    """Start all processes, and end them at exit; `faults` are active on the bus from the start."""
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
            if running is not None:
                end(running)


def end(running: Trial) -> None:
    """Kill a guardian that is still trying, and close the descriptors."""
    guardian = running.guardian or guardian_of(running.port)
    if alive(guardian) and is_guardian(guardian):
        with suppress(ProcessLookupError):
            os.kill(guardian, signal.SIGKILL)
    for descriptor in running.taken:
        os.close(descriptor)


def under_way(running: Trial) -> None:
    """Wait until the program performs the activity in which it will be ended.

    Raises:
        NotMeasuredError: It does not, or drives no motor.
    """
    running.wait_for_message("doing")
    assert running.program.pid is not None
    running.guardian = guardian_of(running.port)
    running.planner = child_with(running.program.pid, "plan_worker")
    if not running.journal.wait_until_still(1.0, still=False):
        raise NotMeasuredError("no motor is driven though the run has begun")
