"""The runs that the thesis' figures need, as plain data."""

from typing import Any

from windup.tools.reproduce.study.figure import Job, Result, Results

STEPS = 60
SEEDS = 8
SAMPLINGS = ("fl", "lf", "sp")  # the order of the thesis' panels
NAMES = {"fl": "F-L", "lf": "L-F", "sp": "SP"}


def walk(**options: Any) -> Job:
    """Return a walk with the thesis' control; options are those of `work.walk`."""
    base: dict[str, Any] = {
        "rv": ["up"],
        "sampling": "fl",
        "forward": 0.25,
        "lateral": 0.0,
        "servo": False,
        "steps": STEPS,
        "seed": 0,
    }
    unknown = set(options) - set(base) - {"open_loop", "law", "hold", "turn", "limits"}
    assert not unknown, unknown
    return Job("walk", base | options)


def seeds(count: int, **options: Any) -> list[Job]:
    """Return the same walk from several seeds."""
    return [walk(**options, seed=seed) for seed in range(count)]


def walked(result: Result) -> bool:
    """Tell whether a walk has come to its end."""
    return bool(result["steps"] >= result["requested"] and not result["fell"])


def cell(jobs: list[Job], results: Results) -> list[Result]:
    """Return the results of those jobs that have been run."""
    return [results[job] for job in jobs if job in results]
