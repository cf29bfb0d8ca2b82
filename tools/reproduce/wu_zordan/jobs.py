"""The runs that the paper's statements need, as plain data."""

from collections.abc import Sequence
from typing import Any

from windup.tools.reproduce.study.figure import Job, Result, Results

DURATION = 0.1  # s, of a push
AROUND = tuple(22.5 * k for k in range(16))
EIGHT, FOUR = AROUND[::2], AROUND[::4]


def push(force: float, directions: Sequence[float], way: str = "momentum", **more: Any) -> Job:
    """Return pushes of `force` N toward `directions`, degrees, one after the other."""
    return Job("push", {"force": force, "directions": list(directions), "way": way} | more)


def walk(robot: str, steps: int, seed: int) -> Job:
    """Return random footprints, each of any length, direction and turn within reach."""
    return Job("walk", {"robot": robot, "steps": steps, "seed": seed})


def turn(robot: str, steps: int, angle: float) -> Job:
    """Return steps on the spot, the first foot of each pair turned by `angle` degrees."""
    return Job("turn", {"robot": robot, "steps": steps, "angle": angle})


def cell(jobs: Sequence[Job], results: Results) -> list[Result]:
    """Return the results of those jobs that have been run."""
    return [results[job] for job in jobs if job in results]


def count(runs: Sequence[Result], key: str = "survived") -> str:
    """Return how many of some runs did it, for people."""
    return f"{sum(bool(run[key]) for run in runs)} of {len(runs)}"


def where(runs: Sequence[Result]) -> str:
    """Return the directions of some runs, for people."""
    return ", ".join(f"{run['directions'][0]:g}" for run in runs) + " degrees" if runs else "none"
