"""Checks that the guardian does not take over a robot during a long walk on a busy computer."""

import multiprocessing
import tempfile
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from windup.hal.errors import WindupError
from windup.hal.observation import Observation
from windup.tools.benches.safety.emulated import serve
from windup.tools.robot.robot import Robot
from windup.tools.terminal.output import console

STEPS = 400
"""Steps of one walk; then the robot rests, and walks again."""


def measure_takeovers(name: str, minutes: float = 30.0, speed: float = 0.1) -> dict[str, Any]:
    """Return how often the guardian took over during a walk beside a process that uses one core.

    The servos are those of `windup emulate` on a pseudo-terminal, in real time. A walk whose robot
    falls ends by itself, is counted, and is followed by the next.

    Args:
        name: The robot.
        minutes: Total duration of the walks.
        speed: Walking speed, m/s.
    """
    context = multiprocessing.get_context("spawn")
    busy = context.Process(target=_spin, daemon=True)
    busy.start()
    walked, taken, fallen, failed, longest = 0.0, 0, 0, 0, 0.0
    try:
        while walked < 60.0 * minutes:
            told, tell = context.Pipe(duplex=False)
            left = 60.0 * minutes - walked
            walk = context.Process(target=_walk, args=(name, speed, left, tell))
            walk.start()
            tell.close()
            walk.join()
            report = _last(told)
            walked += report["seconds"]
            longest = max(longest, report["longest_gap_s"])
            taken += walk.exitcode == -9
            fallen += report["reason"] == "fell"
            failed += report["reason"] not in ("fell", "done")
            console.print(f"{walked:.0f} s walked, {taken} takeovers: {report['reason']}")
            if failed > 3 + walked / 60.0:
                raise WindupError(f"most walks fail: {report['reason']}")
    finally:
        busy.kill()
    return {
        "minutes": round(walked / 60.0, 2),
        "takeovers": taken,
        "falls": fallen,
        "failed": failed,
        "longest_gap_s": round(longest, 4),
        "met": taken == 0,
    }


def _last(told: Connection) -> dict[str, Any]:
    """Return the last report of a walk, which sends one per second because it may be killed."""
    report: dict[str, Any] = {"seconds": 0.0, "reason": "it did not begin", "longest_gap_s": 0.0}
    try:
        while True:
            report = told.recv()
    except EOFError:
        return report


def _walk(name: str, speed: float, seconds: float, tell: Connection) -> None:
    """Walk an emulated robot for `seconds`; the main function of a process that may be killed."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    with tempfile.TemporaryDirectory() as folder:
        emulator = context.Process(target=serve, args=(name, Path(folder) / "bus", theirs))
        emulator.daemon = True
        emulator.start()
        try:
            with Robot.open(name, port=ours.recv(), arm=True) as robot:
                gaps = Gaps(tell, seconds)
                robot.watch.append(gaps.update)
                try:
                    robot.walk(speed, steps=STEPS, on_step=[gaps.end_in_time()])
                finally:
                    robot.watch.clear()
                    gaps.tell("done" if gaps.over else robot.loop.reason)
        except (WindupError, KeyboardInterrupt) as error:
            console.print(f"windup: {error}", markup=False, soft_wrap=True)
        finally:
            emulator.kill()


class Gaps:
    """Measures the longest time between the ticks of a walk, and reports it once a second."""

    def __init__(self, tell: Connection, seconds: float) -> None:
        self._tell, self._seconds = tell, seconds
        self._began = self._last = self._told = time.monotonic()
        self._longest = 0.0
        self._walking = False
        self.over = False

    def update(self, observation: Observation) -> None:
        """Record a tick."""
        now = time.monotonic()
        if self._walking:
            self._longest = max(self._longest, now - self._last)
        self._last = now
        if now - self._told > 1.0:
            self._told = now
            self.tell("killed")

    def end_in_time(self) -> Callable[[int, float], None]:
        """Return a step callback that ends the walk after its duration."""

        def on_step(number: int, speed: float) -> None:
            self._walking = True
            if time.monotonic() - self._began > self._seconds:
                self.over = True
                raise KeyboardInterrupt

        return on_step

    def tell(self, reason: str) -> None:
        """Send a report with the results so far."""
        seconds = time.monotonic() - self._began
        self._tell.send({"seconds": seconds, "reason": reason, "longest_gap_s": self._longest})


def _spin() -> None:
    """Keep one core busy."""
    while True:
        pass
