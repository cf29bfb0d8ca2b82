"""Figures 4.4-4.6, 4.10, 4.11, 4.13: regulation variables at the ends of steps."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from windup.hal.joints import Array
from windup.tools.reproduce.laszlo.jobs import NAMES, walk, walked
from windup.tools.reproduce.laszlo.recorder import records
from windup.tools.reproduce.study.figure import Claim, Figure, Job, Result, Results

STEADY = 20  # steps left out as start-up
BAND = 0.02  # of the steady value: settled

MIDDLE = walk(sampling="lf", forward=0.2)
UPPER = walk(sampling="sp", forward=0.3)
CHAOTIC = walk(sampling="lf", forward=0.35)
SWING_LF = walk(rv=["swing_com"], sampling="lf", forward=0.05)
SWING_SP = walk(rv=["swing_com"], sampling="sp", forward=0.0)
SWING_WIDE = walk(rv=["swing_com"], sampling="sp", forward=0.0, lateral=-0.03)


def draw(job: Job, canvas: Any, results: Results) -> None:
    """Draw both components against the step number, with their targets dotted."""
    result = results[job]
    steps = np.arange(1, result["steps"] + 1)
    for column, axis in enumerate(canvas.subplots(1, 2)):
        axis.plot(steps, records(result, "q")[:, column], marker=".")
        axis.plot(steps, records(result, "target")[:, column], "k:")
        axis.set(xlabel="step", title=result["variables"][column])


def error(result: Result) -> float:
    """Return the rms distance from the target once started, of both components."""
    off = records(result, "q") - records(result, "target")
    off = off[STEADY:] if len(off) > 2 * STEADY else off[len(off) // 2 :]
    return float(np.sqrt(np.mean(off**2))) if len(off) else float("nan")


def settled(values: Array) -> int | None:
    """Return the step from which every second value stays near its last ones; None for never.

    Sides are looked at one by one: a steady walk may limp.
    """
    late = []
    for side in (values[0::2], values[1::2]):
        if len(side) < 10:
            return None
        out = np.flatnonzero(np.abs(side - side[-5:].mean()) > BAND)
        late.append(0 if not len(out) else 2 * (int(out[-1]) + 1))
    start = max(late)
    return start if start < len(values) - 6 else None


def _ends(job: Job, results: Results) -> Claim:
    result = results[job]
    return Claim("walks 60 steps", f"{result['steps']} steps", "60, without a fall", walked(result))


def claims_steady(job: Job, results: Results) -> list[Claim]:
    """Judge the start-up and the two components of a steady walk."""
    q = records(results[job], "q")
    starts = [settled(q[:, column]) for column in (0, 1)]
    texts = ["not settled" if start is None else f"from step {start}" for start in starts]
    late = q[STEADY:]
    spread = late[0::2].std(axis=0) + late[1::2].std(axis=0) if len(late) > 4 else [np.nan] * 2
    return [
        _ends(job, results),
        Claim(
            "a start-up of 5 to over 20 steps, then steady",
            f"forward {texts[0]}, lateral {texts[1]}",
            f"the forward component within {BAND:g} of its last values from step 30 on or before",
            starts[0] is not None and starts[0] <= 30,
        ),
        Claim(
            "the forward component varies less than the lateral one",
            f"standard deviations {spread[0] / 2:.4f} and {spread[1] / 2:.4f}",
            "forward below lateral",
            bool(spread[0] < spread[1]),
        ),
    ]


def claims_chaotic(results: Results) -> list[Claim]:
    """Judge the chaotic walk against the steady ones."""
    wild, calm = error(results[CHAOTIC]), [error(results[job]) for job in (MIDDLE, UPPER)]
    return [
        _ends(CHAOTIC, results),
        Claim(
            "errors are far larger than in the steady walks",
            f"rms {wild:.3f}; steady {calm[0]:.3f} and {calm[1]:.3f}",
            "above twice each",
            wild > 2.0 * max(calm),
        ),
    ]


def claims_swing(job: Job, results: Results) -> list[Claim]:
    """Judge a swing-COM walk against the up vector's."""
    theirs, best = error(results[job]), error(results[MIDDLE])
    return [
        _ends(job, results),
        Claim(
            "farther from the target than with the up vector",
            f"rms {theirs:.3f}; up vector {best:.3f}",
            "above",
            theirs > best,
        ),
    ]


def claims_wide(results: Results) -> list[Claim]:
    """Judge what a lateral target does."""
    means = [abs(records(results[job], "q")[:, 1].mean()) for job in (SWING_WIDE, SWING_SP)]
    return [
        _ends(SWING_WIDE, results),
        Claim(
            "feet are placed to the side of the centre of mass instead of on one line",
            f"mean lateral distance {means[0]:.3f}; with a target of zero {means[1]:.3f}",
            "larger, and within 0.02 of the target 0.03",
            bool(means[0] > means[1] and abs(means[0] - 0.03) < 0.02),
        ),
    ]


Judge = Callable[[Results], list[Claim]]


def _figure(name: str, job: Job, statement: str, judge: Judge, *more: Job) -> Figure:
    options = job.options
    title = f"{options['rv'][0]}, {NAMES[options['sampling']]}, Q = {options['forward']:g}"
    title += f", lateral ±{abs(options['lateral']):g}" if options["lateral"] else ""
    return Figure(
        name,
        f"Values at the ends of steps: {title}",
        statement,
        lambda quick: [job, *more],
        partial(draw, job),
        judge,
    )


FIGURES = (
    _figure(
        "4.4",
        MIDDLE,
        "A steady walk: after a start-up of some ten steps both components stay near the target, "
        "the forward one sooner and closer than the lateral one.",
        partial(claims_steady, MIDDLE),
    ),
    _figure(
        "4.5",
        UPPER,
        "Steady too; the target is not quite reached, and yet there is a limit cycle.",
        partial(claims_steady, UPPER),
    ),
    _figure(
        "4.6",
        CHAOTIC,
        "A chaotic walk that does not fall: its errors are much larger than those of steady walks.",
        claims_chaotic,
        MIDDLE,
        UPPER,
    ),
    _figure(
        "4.10",
        SWING_LF,
        "Typical of swing-COM: larger, irregular oscillations and drift.",
        partial(claims_swing, SWING_LF),
        MIDDLE,
    ),
    _figure(
        "4.11",
        SWING_SP,
        "Typical of swing-COM with SP sampling; each foot lands in line with the last, as on a "
        "tightrope.",
        partial(claims_swing, SWING_SP),
        MIDDLE,
    ),
    _figure(
        "4.13",
        SWING_WIDE,
        "A lateral target of .03 away from the body ends the tightrope walk, without a fall.",
        claims_wide,
        SWING_SP,
    ),
)
