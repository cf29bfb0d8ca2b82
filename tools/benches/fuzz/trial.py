"""One odd run in a process of its own: its exit status, exception and memory."""

import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from windup.robots import load_robot
from windup.robots.folders import gait_files
from windup.tools.benches.fuzz.broken_mjcf import broken_mjcf
from windup.tools.benches.fuzz.broken_toml import broken_toml
from windup.tools.benches.fuzz.odd_line import odd_line

KNOWN = {0, 1, 2, 3, 130}
"""Exit statuses that are defined."""
PATIENCE = 20
"""Time after which a run is interrupted, as a user would, s."""
MEMORY = 1 << 30
"""Memory that no run may exceed, bytes."""


@dataclass(frozen=True)
class Trial:
    """The result of one odd run.

    Attributes:
        seed: Seed of its random numbers.
        words: Its command line.
        status: Its exit status; None if it ended with an exception.
        trace: Traceback of the exception, or "".
        interrupted: Whether it had to be interrupted.
        memory: Peak memory of its process so far, bytes.
    """

    seed: int
    words: tuple[str, ...]
    status: int | None
    trace: str
    interrupted: bool
    memory: int

    @property
    def fault(self) -> str:
        """Description of what is wrong with the run, or ""."""
        if self.trace:
            return self.trace.strip().splitlines()[-1]
        if self.status not in KNOWN:
            return f"exit status {self.status}"
        return f"{self.memory >> 20} MB" if self.memory > MEMORY else ""


Run = Callable[[list[str]], int]
"""The command line entry point: from words to an exit status."""


def odd_run(run: Run, seed: int, robots: tuple[str, ...]) -> Trial:
    """Run one odd command line on one of `robots`, possibly a broken copy."""
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory(prefix="windup-fuzz-") as name:
        folder = Path(name)
        robot = _robot(rng, rng.choice(robots), folder / "robot")
        words = odd_line(rng, robot, folder)
        interrupted = False

        def interrupt(number: int, frame: object) -> None:
            nonlocal interrupted
            interrupted = True
            signal.alarm(PATIENCE)  # interrupt again if once is not enough
            os.kill(os.getpid(), signal.SIGINT)

        signal.signal(signal.SIGALRM, interrupt)
        signal.alarm(PATIENCE)
        status, trace = None, ""
        here = os.getcwd()
        os.chdir(folder)
        try:
            with _silenced():
                status = run(words)
        except BaseException:
            trace = traceback.format_exc()
        finally:
            signal.alarm(0)
            signal.signal(signal.SIGINT, signal.default_int_handler)
            os.chdir(here)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    return Trial(seed, tuple(words), status, trace, interrupted, memory)


def _robot(rng: random.Random, name: str, folder: Path) -> str:
    """Return the name of a robot, or the path of a broken copy of it."""
    if rng.random() < 0.2:
        return name
    shutil.copytree(load_robot(name).folder, folder)
    toml, mjcf = folder / "robot.toml", folder / "model.xml"
    if rng.random() < 0.6:
        toml.write_text(broken_toml(rng, toml.read_text()))
    else:
        mjcf.write_text(broken_mjcf(rng, mjcf.read_text()))
    gaits = list(gait_files(folder).values())
    if gaits and rng.random() < 0.3:
        gait = rng.choice(gaits)
        gait.write_text(broken_toml(rng, gait.read_text()))
    return str(folder)


@contextmanager
def _silenced() -> Iterator[None]:
    """Discard all output, also that of C libraries."""
    kept = [os.dup(number) for number in (1, 2)]
    nothing = os.open(os.devnull, os.O_WRONLY)
    try:
        for number in (1, 2):
            os.dup2(nothing, number)
        yield
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        for number, old in zip((1, 2), kept, strict=True):
            os.dup2(old, number)
            os.close(old)
        os.close(nothing)
