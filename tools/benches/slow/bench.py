"""Walks robots on a slow computer: the loop, its planner and guardian on a share of one core."""

import multiprocessing
import os
import tempfile
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Final, Literal

from windup.hal.errors import WindupError
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.benches.safety.emulated import serve
from windup.tools.benches.slow.cpu_share import cpu_share
from windup.tools.robot.robot import Robot
from windup.tools.stopping.interrupts import RunInterruptedError
from windup.tools.terminal.output import console

SHARE: Final = 0.35
"""Share of one core that a slow robot computer has."""
STEPS = 100_000
"""More than fit into a walk; it ends after its time."""
MODELS: Final[dict[str, Literal["full", "library"]]] = {"op3": "library"}
"""How a robot's step models are sampled; others sample them in full."""


def measure_slow(name: str | None = None, minutes: float = 1.0) -> dict[str, Any]:
    """Return how many ticks and plans came late in walks on a share of one core.

    The servos are those of `windup emulate` on a pseudo-terminal, in real time, in a process that
    is not limited.

    Args:
        name: The robot; op3 and the duck if None.
        minutes: Duration of each walk.

    Raises:
        UsageError: This user may not limit the CPU time of processes.
    """
    names = ("op3", "duck") if name is None else (name,)
    with cpu_share(SHARE) as group:
        rows = [_measure(each, 60.0 * minutes, group) for each in names]
    for row in rows:
        console.print(
            f"{row['robot']}: {row['seconds']:.0f} s at {row['rate_hz']:g} Hz, "
            f"{row['missed']} ticks missed, {row['late_plans']} plans late: {row['reason']}"
        )
    good = all(row["missed"] == row["late_plans"] == 0 and row["reason"] == "done" for row in rows)
    return {"share_of_a_core": SHARE, "rows": rows, "met": good}


def _measure(name: str, seconds: float, group: Path) -> dict[str, Any]:
    """Walk one robot and return its row."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    told, tell = context.Pipe(duplex=False)
    with tempfile.TemporaryDirectory() as folder:
        emulator = context.Process(target=serve, args=(name, Path(folder) / "bus", theirs))
        emulator.daemon = True
        emulator.start()
        try:
            walk = context.Process(target=_walk, args=(name, ours.recv(), seconds, group, tell))
            walk.start()
            tell.close()
            row: dict[str, Any] = told.recv()
            walk.join()
        except EOFError:
            raise WindupError(f"the walk of {name} ended without a result; see above") from None
        finally:
            emulator.kill()
    return row


def _walk(name: str, port: str, seconds: float, group: Path, tell: Connection) -> None:
    """Walk an emulated robot in a control group; the main function of a process."""
    group.write_text(str(os.getpid()))
    options = WalkOptions(model=MODELS.get(name, "full"))
    with Robot.open(name, port=port, arm=True) as robot:
        try:
            reason = robot.walk(steps=STEPS, options=options, on_step=[_end(seconds)]).loop.reason
        except RunInterruptedError:
            reason = "done"
        slowness = robot.slowness
        tell.send(
            {
                "robot": name,
                "rate_hz": slowness.rate_hz,
                "seconds": round(slowness.ticks / slowness.rate_hz, 1),
                "missed": slowness.missed,
                "plans": slowness.plans,
                "late_plans": slowness.late,
                "tick_ms": robot.loop.tick_ms(),
                "reason": reason,
            }
        )


def _end(seconds: float) -> Callable[[int, float], None]:
    """Return a step callback that ends a walk after its duration."""
    began = time.monotonic()

    def on_step(number: int, speed: float) -> None:
        if time.monotonic() - began > seconds:
            raise KeyboardInterrupt

    return on_step
