"""How soon the torque is off when a controller is told to end, crashes, or dies."""

from collections import Counter
from collections.abc import Sequence
from typing import Any, get_args

import numpy as np
from rich.progress import track

from hal.errors import WindupError
from hal.guard import CROUCH_SECONDS
from robots import load_robot
from tools.output import console
from tools.stop_rig import End, Moment, NotMeasuredError, end_one

ENDS: tuple[End, ...] = get_args(End)
LONGEST = 3.0  # s of moving before the end, at most
ALLOWED = 0.25  # s until the torque has to be off, beside a crouch if that is the policy


def measure_stops(
    name: str, moments: int = 20, seed: int = 0, ends: Sequence[End] = ENDS
) -> dict[str, Any]:
    """Return, for each way to end a run, how many stops came in time, and the longest, s.

    A robot whose servos have a watchdog walks; one that needs the guardian stands and plays.

    Args:
        name: The robot.
        moments: Random moments for each way to end.
        seed: Their seed.
        ends: The ways.

    Raises:
        WindupError: More runs failed for reasons of their own than were measured.
    """
    rng = np.random.default_rng(seed)
    crouches = load_robot(name).stop == "crouch"
    result: dict[str, Any] = {}
    for end in ends:
        # Nobody is left after SIGKILL who could crouch.
        allowed = ALLOWED + (CROUCH_SECONDS if crouches and end != "SIGKILL" else 0.0)
        result[end] = _measure_end(name, end, moments, allowed, rng)
        console.print(f"{end}: {result[end]}")
    return result


def _measure_end(
    name: str, end: End, moments: int, allowed: float, rng: np.random.Generator
) -> dict[str, Any]:
    """Return how one way to end went; runs that fail by themselves are counted, and done anew."""
    times: list[float] = []
    doing: Counter[str] = Counter()
    failed: Counter[str] = Counter()
    for _ in track(range(moments), end, console=console, transient=True):
        done = len(times)
        while len(times) == done:
            moment = Moment(end, float(rng.uniform(0.0, LONGEST)), int(rng.integers(2**31)))
            try:
                what, seconds = end_one(name, moment)
            except NotMeasuredError as error:
                failed[str(error)] += 1
                if failed.total() > 3 + done:
                    raise WindupError(f"most runs fail before their end: {error}") from error
                continue
            doing[what] += 1
            times.append(seconds)
    return {
        "moments": moments,
        "allowed_s": allowed,
        "off_in_time": sum(t <= allowed for t in times),
        "longest_s": round(max(times), 3),
        "while": dict(doing),
        "not_measured": dict(failed),
    }
