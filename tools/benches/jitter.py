"""Measures the wake-up lateness of our loop, beside a C program that only sleeps."""

import multiprocessing
import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from windup.hal.backend import Clock
from windup.hal.errors import UsageError, WindupError
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.tools.benches.safety.emulated import serve
from windup.tools.robot.robot import Robot
from windup.tools.terminal.output import console

RATE = 125.0  # Hz
FACTOR, MARGIN = 2.0, 0.2  # allowed p99.9: this factor times the C loop's, plus this margin, ms
SOURCE = Path(__file__).with_name("c_loop.c")


class WakeLog:
    """A clock that records how late its waits end.

    Attributes:
        late: Lateness of each wait, s.
    """

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.late: list[float] = []

    def now(self) -> float:
        """Return the time, s."""
        return self.clock.now()

    def wait_until(self, time_: float) -> None:
        """Wait until `time_`, s."""
        self.clock.wait_until(time_)
        self.late.append(self.clock.now() - time_)


def measure_jitter(name: str, minutes: float = 10.0) -> dict[str, Any]:
    """Return the lateness of both loops, running simultaneously at 125 Hz, ms.

    Ours is the complete loop: the robot stands, armed, on the servos of `windup emulate` on a
    pseudo-terminal, which another process emulates in real time.

    Args:
        name: The robot.
        minutes: Duration of the measurement.

    Raises:
        UsageError: There is no C compiler.
        WindupError: The robot fell.
    """
    ticks = round(60.0 * minutes * RATE)
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    with tempfile.TemporaryDirectory() as folder:
        program = compile_c(Path(folder))
        arguments = (name, Path(folder) / "bus", theirs)
        emulator = context.Process(target=serve, args=arguments, daemon=True)
        emulator.start()
        try:
            port = ours.recv()
            with Robot.open(name, port=port, arm=True, rate=RATE) as robot:
                robot.stand(1.0)
                late, other, missed = _side_by_side(robot, program, ticks)
        finally:
            emulator.kill()
            emulator.join()
    return _compare(late, other, missed)


def compile_c(folder: Path) -> Path:
    """Compile the C loop into a folder and return its path.

    Raises:
        UsageError: There is no compiler, or it fails.
    """
    compiler = shutil.which(os.environ.get("CC", "cc"))
    if compiler is None:
        raise UsageError("bench loop needs a C compiler for the loop beside ours: install cc")
    program = folder / "c_loop"
    command = [compiler, "-O2", "-o", str(program), str(SOURCE)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise UsageError(f"{compiler} does not compile {SOURCE.name}: {done.stderr.strip()[:200]}")
    return program


def run_c(program: Path, ticks: int) -> "subprocess.Popen[str]":
    """Start the C loop for a number of ticks."""
    command = [str(program), str(round(1e9 / RATE)), str(ticks)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


def _side_by_side(
    robot: Robot, program: Path, ticks: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], int]:
    """Run both loops; return their latenesses, s, and the number of ticks that ours missed."""
    backend = robot.backend.backend
    assert isinstance(backend, ServoBackend)
    log = WakeLog(backend.clock)
    backend.clock = log
    console.print(f"{ticks} ticks of both loops, {ticks / RATE / 60.0:.1f} minutes ...")
    beside = run_c(program, ticks)
    try:
        if robot.stand(ticks / RATE).reason != "done":
            raise WindupError(f"the robot does not stand: {robot.loop.reason}")
        late, missed = np.array(log.late), robot.loop.missed
        said, _ = beside.communicate()
    finally:
        beside.kill()
        backend.clock = log.clock
    return late, np.array(said.split(), float) * 1e-9, missed


def _compare(late: NDArray[np.float64], other: NDArray[np.float64], missed: int) -> dict[str, Any]:
    """Return the percentiles of both loops, and whether ours is within the allowed lateness."""
    percents = (50.0, 99.0, 99.9, 100.0)
    result: dict[str, Any] = {"rate_hz": RATE, "ticks": len(late), "missed": missed}
    for key, values in (("ours", late), ("c", other)):
        for percent, value in zip(percents, np.percentile(values, percents) * 1e3, strict=True):
            result[f"{key}_p{percent:g}_ms"] = round(float(value), 4)
    result["allowed_p99.9_ms"] = round(FACTOR * result["c_p99.9_ms"] + MARGIN, 4)
    result["met"] = result["ours_p99.9_ms"] <= result["allowed_p99.9_ms"]
    return result
