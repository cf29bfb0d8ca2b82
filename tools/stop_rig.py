"""A robot that moves in front of an emulator until its controller is ended, and what follows."""

import multiprocessing
import os
import signal
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import cycle
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Literal

import numpy as np

from hal.errors import WindupError
from hal.observation import Observation
from sim_twin.wire import parse_address
from sim_twin.wire.emulate import Emulator, emulate
from tools.gaits import find_gait
from tools.robot import Robot

End = Literal["SIGINT", "SIGTERM", "exception", "SIGKILL"]
PATIENCE = 60.0  # s until a run has to be under way
NEVER = 10.0  # s after which motors that are still driven count as never switched off
READ_BACK = 0.3  # s for whoever has switched the torque off to see that it is off
# What a fresh process would import anew each time: nothing of it is kept from run to run.
PRELOAD = ["tools.robot", "tools.stop_rig", "sim_twin.wire.emulate"]


class NotMeasuredError(WindupError):
    """The robot was not moving any more, or never, when it should have been ended."""


@dataclass(frozen=True)
class Moment:
    """When and how a run ends.

    Attributes:
        end: How.
        after: So long after it began to move, s.
        seed: Of the order of the gestures.
    """

    end: End
    after: float
    seed: int


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

    def wait_for(self, still: bool, patience: float) -> float | None:
        """Return when all motors were let go (`still`), or one was driven; None: not in time."""
        until = time.monotonic() + patience
        while (self.driven == 0) is not still:
            if not self.pipe.poll(max(until - time.monotonic(), 0.0)):
                return None
            self.since, self.driven = self.pipe.recv()
        return self.since


def end_one(name: str, moment: Moment) -> tuple[str, float]:
    """Move, end it, and return what it was doing and the time until no motor is driven, s.

    The time is infinite if that never came.

    Raises:
        NotMeasuredError: The run did not begin, or was over before its end.
    """
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(PRELOAD)
    ours, theirs = context.Pipe()
    told, tell = context.Pipe(duplex=False)
    with tempfile.TemporaryDirectory() as folder:
        emulator = context.Process(
            target=serve, args=(name, Path(folder) / "bus", theirs), daemon=True
        )
        emulator.start()
        theirs.close()
        started: list[BaseProcess] = [emulator]
        try:
            if not ours.poll(PATIENCE):
                raise NotMeasuredError("the emulator does not start")
            port = ours.recv()
            mover = context.Process(target=_move, args=(name, port, moment, tell), daemon=True)
            mover.start()
            tell.close()
            started.append(mover)
            return _watch(mover, moment, told, Journal(ours))
        except EOFError:
            raise NotMeasuredError("the emulator is gone") from None
        finally:
            for process in reversed(started):
                process.kill()
                process.join()


def _watch(
    mover: BaseProcess, moment: Moment, told: Connection, journal: Journal
) -> tuple[str, float]:
    """End a run that has been started; return as `end_one`."""
    doing = _hear(told, PATIENCE)
    if journal.wait_for(False, 1.0) is None:
        raise NotMeasuredError("no motor is driven though the run has begun")
    due = time.monotonic() + moment.after
    while moment.end == "exception" or time.monotonic() < due:
        patience = PATIENCE if moment.end == "exception" else max(due - time.monotonic(), 0.0)
        if told.poll(patience):
            heard = _hear(told, 0.0)
            if isinstance(heard, float):
                ended = heard
                break
            doing = heard
        elif moment.end == "exception":
            raise NotMeasuredError(f"no exception came in {PATIENCE:g} s")
    else:
        assert mover.pid is not None
        os.kill(mover.pid, getattr(signal, moment.end))
        ended = time.monotonic()
    off = journal.wait_for(True, NEVER)
    if off is None:
        return str(doing), float("inf")
    if off < ended - 0.05:
        raise NotMeasuredError("the motors were off before the end")
    mover.join(NEVER)
    time.sleep(READ_BACK)
    return str(doing), max(off - ended, 0.0)


def _hear(told: Connection, patience: float) -> str | float:
    """Return what a run says: what it does now, or when it crashed, s.

    Raises:
        NotMeasuredError: It failed, it ended, or it is silent.
    """
    if not told.poll(patience):
        raise NotMeasuredError(f"the run did not begin in {patience:g} s")
    try:
        kind, what = told.recv()
    except EOFError:
        raise NotMeasuredError("the run is gone and has not said why") from None
    if kind == "failed":
        raise NotMeasuredError(f"the run failed: {what}")
    return float(what) if kind == "crash" else str(what)


def serve(name: str, path: Path, pipe: Connection, faults: str = "") -> None:
    """Serve the robot for ever, telling how many motors are driven."""
    emulate(
        parse_address(f"twin://{name}?clock=real&faults={faults}"),
        pty=path,
        on_ready=lambda emulator: pipe.send(port_of(emulator)),
        journal=lambda _, driven: pipe.send((time.monotonic(), driven)),
    )


def port_of(emulator: Emulator) -> str:
    """Return what `--port` takes for the buses of an emulator."""
    if len(emulator.outlets) == 1:
        return emulator.outlets[0].name
    return ",".join(f"{outlet.bus.name}={outlet.name}" for outlet in emulator.outlets)


def _move(name: str, port: str, moment: Moment, tell: Connection) -> None:
    """Walk, or stand and play, until the end; say what is going on, and when it crashes."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    began: list[float] = []

    def begin(doing: str) -> None:
        began.append(time.monotonic())
        tell.send(("doing", doing))

    def watch(observation: Observation) -> None:
        if moment.end == "exception" and began and time.monotonic() > began[0] + moment.after:
            tell.send(("crash", time.monotonic()))
            raise ZeroDivisionError("a bug of the controller's own")

    try:
        with suppress(KeyboardInterrupt), Robot.open(name, port=port, arm=True) as robot:
            robot.stand(0.5)
            robot.watch = watch
            _keep_moving(robot, moment.seed, begin)
            tell.send(("failed", f"it ended by itself: {robot.loop.reason}"))
    except WindupError as error:
        tell.send(("failed", str(error)))


def _keep_moving(robot: Robot, seed: int, begin: Callable[[str], None]) -> None:
    """Walk if the servos watch over their host, else stand and play; return if it falls."""
    if robot.description.buses[0].protocol == "dynamixel2":
        robot.walk(steps=1000, on_step=lambda number, _: begin("walking") if number == 1 else None)
        return
    for graph in cycle(np.random.default_rng(seed).permutation(_graphs(robot))):
        begin("standing")
        if robot.stand(1.0).reason != "done":
            return
        begin("playing")
        if robot.play(str(graph)).reason != "done":
            return


def _graphs(robot: Robot) -> list[str]:
    """Return the pose graphs that have an end: gestures."""
    names = sorted(path.stem for path in (robot.description.folder / "gaits").glob("*.toml"))
    return [name for name in names if not find_gait(robot.description, name).graph.periodic]
