"""The runs that the paper's statements need, as plain data."""

from collections.abc import Sequence
from typing import Any

from windup.tools.reproduce.study.figure import Job, Result, Results

STEP = "predictive"
OVER = 4.0  # N s, nothing stands that
NOISE = 0.2  # degrees on the start pose
AROUND = tuple(22.5 * k for k in range(16))
FOUR = AROUND[::4]


def push(impulse: float, directions: Sequence[float], seed: int = 0, **more: Any) -> Job:
    """Return pushes of OP3 one after the other, with its sensors and 10 ms of delay."""
    return Job("push", _options(impulse, directions, seed) | more)


def stride(seed: int = 0, speed: float = 0.1, **more: Any) -> Job:
    """Return a walk of OP3 as `windup stride` has it, with its sensors."""
    options = {"speed": speed, "seed": seed, "noise": NOISE, "state": "estimated"}
    return Job("stride", options | more)


def fall(direction: float, *, protect: bool, seed: int = 0) -> Job:
    """Return a push that nothing can stand, with protection or a stiff fall."""
    how = {"way": "hold", "stance": "stand", "protect": protect}
    return Job("fall", _options(OVER, [direction], seed) | how)


def _options(impulse: float, directions: Sequence[float], seed: int) -> dict[str, Any]:
    return {
        "impulse": impulse,
        "directions": list(directions),
        "seed": seed,
        "noise": NOISE,
        "state": "estimated",
        "delay": 0.01,
    }


def cell(jobs: list[Job], results: Results) -> list[Result]:
    """Return the results of those jobs that have been run."""
    return [results[job] for job in jobs if job in results]


def count(runs: list[Result], key: str = "survived") -> str:
    """Return how many of some runs did it, for people."""
    return f"{sum(bool(run[key]) for run in runs)} of {len(runs)}"
