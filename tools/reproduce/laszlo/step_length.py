"""Figures 4.7 and 4.12: step lengths, regular with the up vector and not with swing-COM."""

from functools import partial
from typing import Any

import numpy as np

from windup.tools.reproduce.laszlo.jobs import walk
from windup.tools.reproduce.laszlo.recorder import records
from windup.tools.reproduce.study.figure import Claim, Figure, Job, Result, Results

UP = walk(sampling="fl", forward=0.25)
SWING = walk(rv=["swing_com"], sampling="sp", forward=0.05)
START = 10


def draw(job: Job, canvas: Any, results: Results) -> None:
    """Draw the length of each step."""
    lengths = records(results[job], "length")
    axis = canvas.subplots()
    axis.plot(np.arange(1, len(lengths) + 1), lengths, marker=".")
    axis.set(xlabel="step", ylabel="step length [m]", ylim=(0.0, None))


def variation(result: Result) -> float:
    """Return standard deviation over mean of the step lengths after the start."""
    lengths = records(result, "length")
    lengths = lengths[START:] if len(lengths) > 2 * START else lengths[2:]
    lengths = lengths[np.isfinite(lengths)]
    return float(lengths.std() / lengths.mean()) if len(lengths) > 2 else float("nan")


def claims_up(results: Results) -> list[Claim]:
    """Judge that steps are alike."""
    value = variation(results[UP])
    mean = float(np.nanmean(records(results[UP], "length")[START:]))
    return [
        Claim(
            "steps are of one length, though nothing regulates it",
            f"varies by {value:.1%} about {mean:.2f} m",
            "10 % or less",
            value <= 0.1,
        )
    ]


def claims_swing(results: Results) -> list[Claim]:
    """Judge that steps are not alike."""
    value, other = variation(results[SWING]), variation(results[UP])
    steps = results[SWING]["steps"]
    return [
        Claim(
            "lengths vary widely from step to step",
            f"varies by {value:.1%} over {steps} steps; with the up vector {other:.1%}",
            "above 10 %, and twice the up vector's",
            value > 0.1 and value > 2.0 * other,
        ),
        Claim("walks 60 steps", f"{steps} steps", "60", steps >= 60),
    ]


FIGURES = (
    Figure(
        "4.7",
        "Step length, up vector",
        "Over a typical walk on the up vector the steps are uniform in length.",
        lambda quick: [UP],
        partial(draw, UP),
        claims_up,
    ),
    Figure(
        "4.12",
        "Step length, swing-COM",
        "With swing-COM (SP, Q = .05) step lengths differ widely from one step to the next.",
        lambda quick: [SWING, UP],
        partial(draw, SWING),
        claims_swing,
    ),
)
