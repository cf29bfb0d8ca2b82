"""How soon the torque is off when a controller is told to end, crashes, or dies."""

import multiprocessing
import os
import signal
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np

from hal.errors import WindupError
from hal.observation import Observation
from tools.robot import Robot

ENDS = ("SIGINT", "SIGTERM", "exception", "SIGKILL")
PATIENCE = 60.0  # s until a walk has to be under way
LONGEST = 3.0  # s of walking before the end, at most


def measure_stops(name: str, moments: int = 20, seed: int = 0) -> dict[str, Any]:
    """Return, for each way to end a walk, the longest time until no motor was driven any more, s.

    Args:
        name: The robot.
        moments: Random moments for each way to end.
        seed: Their seed.
    """
    rng = np.random.default_rng(seed)
    result: dict[str, Any] = {}
    for end in ENDS:
        times = [_end_one(name, end, float(rng.uniform(0.3, LONGEST))) for _ in range(moments)]
        result[end] = {
            "moments": moments,
            "off_within_0.25_s": sum(t <= 0.25 for t in times),
            "longest_s": round(max(times), 3),
        }
    return result


@dataclass
class Journal:
    """What the emulator has said about driven motors, as it comes.

    Attributes:
        pipe: Where it says so.
        driven: Their present number.
        since: When that changed, s on the system's monotonic clock.
    """

    pipe: Connection
    driven: int = 0
    since: float = field(default_factory=time.monotonic)

    def wait_for(self, all_of: int | None, patience: float) -> float:
        """Return when the number became `all_of` (None: anything above 0), s.

        Raises:
            WindupError: It did not within `patience` s.
        """
        until = time.monotonic() + patience
        while not (self.driven == all_of if all_of is not None else self.driven > 0):
            if not self.pipe.poll(max(until - time.monotonic(), 0.0)):
                raise WindupError(f"{self.driven} motors are driven after {patience:g} s")
            self.since, self.driven = self.pipe.recv()
        return self.since


def _end_one(name: str, end: str, after: float) -> float:
    """Walk for `after` s, end it, and return the time until no motor is driven, s."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bus"
        emulator = context.Process(target=_emulate, args=(name, path, theirs), daemon=True)
        emulator.start()
        try:
            ours.recv()
            journal = Journal(ours)
            crash = after if end == "exception" else None
            told, tell = context.Pipe(duplex=False)
            walker = context.Process(target=_walk, args=(name, path, crash, tell), daemon=True)
            walker.start()
            journal.wait_for(None, PATIENCE)
            if not told.poll(PATIENCE):
                raise WindupError("the walk did not begin")
            told.recv()
            ended = _end(walker, end, after, told)
            off = journal.wait_for(0, 10.0)
            walker.join(10.0)
            return max(off - ended, 0.0)
        finally:
            for process in (walker, emulator):
                process.kill()
                process.join()


def _end(walker: Any, end: str, after: float, told: Connection) -> float:
    """End the walk and return when, s on the system's monotonic clock."""
    if end == "exception":
        if not told.poll(PATIENCE):
            raise WindupError("the walk did not crash when it should")
        return float(told.recv())
    time.sleep(after)
    os.kill(walker.pid, getattr(signal, end))
    return time.monotonic()


def _emulate(name: str, path: Path, pipe: Connection) -> None:
    """Serve the robot for ever, telling how many motors are driven."""
    from sim_twin.wire import parse_address
    from sim_twin.wire.emulate import emulate

    emulate(
        parse_address(f"twin://{name}?clock=real"),
        pty=path,
        on_ready=lambda _: pipe.send("ready"),
        journal=lambda _, driven: pipe.send((time.monotonic(), driven)),
    )


def _walk(name: str, path: Path, crash_after: float | None, tell: Connection) -> None:
    """Walk until the end; tell when the walk begins, and when it crashes."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    began: list[float] = []

    def watch(observation: Observation) -> None:
        if not began:
            began.append(observation.time)
            tell.send("walking")
        if crash_after is not None and observation.time > began[0] + crash_after:
            tell.send(time.monotonic())
            raise ZeroDivisionError("a bug of the controller's own")

    with (
        suppress(WindupError, KeyboardInterrupt),
        Robot.open(name, port=str(path), arm=True) as robot,
    ):
        robot.stand(0.5)
        robot.watch = watch
        robot.walk(steps=1000)
