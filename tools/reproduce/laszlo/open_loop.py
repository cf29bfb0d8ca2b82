"""Figure 3.8: the base graph alone falls."""

from typing import Any

import numpy as np

from windup.tools.reproduce.laszlo.jobs import SEEDS, cell, seeds
from windup.tools.reproduce.laszlo.recorder import column
from windup.tools.reproduce.study.figure import Claim, Figure, Job, Results

THESIS_STEPS = 5  # chapter 4


def jobs(quick: bool) -> list[Job]:
    """Return open-loop walks."""
    return seeds(3 if quick else SEEDS, open_loop=True)


def draw(canvas: Any, results: Results) -> None:
    """Draw the fall of one run and the steps of all."""
    left, right = canvas.subplots(1, 2)
    first = next(result for job, result in results.items() if job.options["seed"] == 0)
    left.plot(column(first, "time"), column(first, "z"), label="height of the pelvis [m]")
    left.plot(column(first, "time"), column(first, "up.f"), label="up vector, forward")
    left.set(xlabel="time [s]", title="one fall")
    left.legend()
    steps = [result["steps"] for result in results.values()]
    right.bar(range(len(steps)), steps)
    right.axhline(THESIS_STEPS, color="k", linestyle=":", label="thesis")
    right.set(xlabel="seed", ylabel="steps before the fall")
    right.legend()


def claims(results: Results) -> list[Claim]:
    """Judge the number of steps."""
    steps = [result["steps"] for result in cell(jobs(False), results)]
    middle = float(np.median(steps))
    fell = sum(result["fell"] for result in results.values())
    return [
        Claim(
            "the base graph alone falls",
            f"{fell} of {len(steps)} runs fell",
            "all of them",
            fell == len(steps),
        ),
        Claim(
            f"after {THESIS_STEPS} steps",
            f"median {middle:g}, from {min(steps)} to {max(steps)}",
            "median within one step",
            abs(middle - THESIS_STEPS) <= 1,
        ),
    ]


FIGURES = (
    Figure(
        "3.8",
        "Open loop",
        "Without balance the human takes a few steps on its base graph and falls; chapter 4 "
        "counts five.",
        jobs,
        draw,
        claims,
    ),
)
