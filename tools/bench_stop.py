"""How soon the torque is off when a controller is told to end, crashes, or dies."""

import multiprocessing
import os
import signal
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import cycle
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np

from hal.errors import WindupError
from hal.guard import CROUCH_SECONDS
from hal.observation import Observation
from robots import load_robot
from sim_twin.wire import parse_address
from sim_twin.wire.emulate import Emulator, emulate
from tools.gaits import find_gait
from tools.output import console
from tools.robot import Robot

MOVING = "moving"
ENDS = ("SIGINT", "SIGTERM", "exception", "SIGKILL")
PATIENCE = 60.0  # s until a walk has to be under way
LONGEST = 3.0  # s of moving before the end, at most
READ_BACK = 0.3  # s for whoever has switched the torque off to see that it is off
ALLOWED = 0.25  # s until the torque has to be off, beside a crouch if that is the policy


def measure_stops(name: str, moments: int = 20, seed: int = 0) -> dict[str, Any]:
    """Return, for each way to end a run, the longest time until no motor was driven any more, s.

    A robot whose servos have a watchdog walks; one that needs the guardian stands and plays.

    Args:
        name: The robot.
        moments: Random moments for each way to end.
        seed: Their seed.
    """
    rng = np.random.default_rng(seed)
    crouches = load_robot(name).stop == "crouch"
    result: dict[str, Any] = {}
    for end in ENDS:
        times = [_end_one(name, end, float(rng.uniform(0.3, LONGEST))) for _ in range(moments)]
        # Nobody is left after SIGKILL who could crouch.
        allowed = ALLOWED + (CROUCH_SECONDS if crouches and end != "SIGKILL" else 0.0)
        result[end] = {
            "moments": moments,
            "allowed_s": allowed,
            "off_in_time": sum(t <= allowed for t in times),
            "longest_s": round(max(times), 3),
        }
        console.print(f"{end}: {result[end]}")
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
    """Move for `after` s, end it, and return the time until no motor is driven, s."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bus"
        emulator = context.Process(target=_emulate, args=(name, path, theirs), daemon=True)
        emulator.start()
        try:
            port = ours.recv()
            journal = Journal(ours)
            crash = after if end == "exception" else None
            told, tell = context.Pipe(duplex=False)
            walker = context.Process(target=_move, args=(name, port, crash, tell), daemon=True)
            walker.start()
            journal.wait_for(None, PATIENCE)
            if not told.poll(PATIENCE):
                raise WindupError("the run did not begin")
            if (said := told.recv()) != MOVING:
                raise WindupError(f"the run did not begin: {said}")
            ended = _end(walker, end, after, told)
            off = journal.wait_for(0, 10.0)
            if off < ended - 0.05:
                raise WindupError("the motors were off before the end; the robot had fallen?")
            walker.join(10.0)
            time.sleep(READ_BACK)
            return max(off - ended, 0.0)
        finally:
            for process in (walker, emulator):
                process.kill()
                process.join()


def _end(walker: Any, end: str, after: float, told: Connection) -> float:
    """End the run and return when, s on the system's monotonic clock."""
    if end == "exception":
        if not told.poll(PATIENCE):
            raise WindupError("the run did not crash when it should")
        return float(told.recv())
    time.sleep(after)
    os.kill(walker.pid, getattr(signal, end))
    return time.monotonic()


def _emulate(name: str, path: Path, pipe: Connection) -> None:
    """Serve the robot for ever, telling how many motors are driven."""
    emulate(
        parse_address(f"twin://{name}?clock=real"),
        pty=path,
        on_ready=lambda emulator: pipe.send(_port(emulator)),
        journal=lambda _, driven: pipe.send((time.monotonic(), driven)),
    )


def _port(emulator: Emulator) -> str:
    """Return what `--port` takes for the buses of an emulator."""
    if len(emulator.outlets) == 1:
        return emulator.outlets[0].name
    return ",".join(f"{outlet.bus.name}={outlet.name}" for outlet in emulator.outlets)


def _move(name: str, port: str, crash_after: float | None, tell: Connection) -> None:
    """Walk, or stand and play, until the end; tell when that begins, and when it crashes."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    began: list[float] = []

    def begin(number: int = 1, speed: float = 0.0) -> None:
        if not began:
            began.append(time.monotonic())
            tell.send(MOVING)

    def watch(observation: Observation) -> None:
        if crash_after is not None and began and time.monotonic() > began[0] + crash_after:
            tell.send(time.monotonic())
            raise ZeroDivisionError("a bug of the controller's own")

    try:
        with suppress(KeyboardInterrupt), Robot.open(name, port=port, arm=True) as robot:
            robot.stand(0.5)
            robot.watch = watch
            if robot.guardian is None:
                robot.walk(steps=1000, on_step=begin)
                return
            begin()
            for graph in cycle(_graphs(robot)):
                robot.stand(1.0)
                robot.play(graph)
    except WindupError as error:
        tell.send(str(error))


def _graphs(robot: Robot) -> list[str]:
    """Return the pose graphs that have an end: gestures."""
    names = sorted(path.stem for path in (robot.description.folder / "gaits").glob("*.toml"))
    return [name for name in names if not find_gait(robot.description, name).graph.periodic]
