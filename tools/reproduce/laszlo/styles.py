"""Figures 5.15 to 5.20: bent knees, bent over, and both with a bent neck to duck."""

from functools import partial
from typing import Any

import numpy as np

from windup.tools.reproduce.laszlo.jobs import walked
from windup.tools.reproduce.laszlo.recorder import column
from windup.tools.reproduce.laszlo.tours import tour
from windup.tools.reproduce.study.figure import Claim, Figure, Job, Result, Results

BEGIN, END = 5.0, 14.0  # s: in and out again
STEPS = 60
KNEES = tour(style=[f"bent_knee=1@{BEGIN:g}:{END:g}"], steps=STEPS)
OVER = tour(style=[f"bent_over=1@{BEGIN:g}:{END:g}"], steps=STEPS)
DUCK = tour(style=[f"duck=1@{BEGIN:g}:{END:g}"], steps=STEPS)
PLAIN = tour(steps=STEPS)


def draw(job: Job, canvas: Any, results: Results) -> None:
    """Draw the height of the pelvis and the bend of the spine over time."""
    height, bend = canvas.subplots(2, 1, sharex=True)
    for run, label in ((results[job], "in and out"), (results[PLAIN], "plain walk")):
        height.plot(column(run, "time"), column(run, "z"), label=label)
        bend.plot(column(run, "time"), np.degrees(_values(run, "bend")))
    height.set(ylabel="pelvis height [m]")
    height.legend(fontsize="small")
    bend.set(xlabel="time [s]", ylabel="spine bent by [deg]")


def _change(job: Job, results: Results, name: str) -> tuple[float, float]:
    """Return the mean of a column during the style, and after it, over that of the plain walk."""
    run, plain = results[job], _values(results[PLAIN], name).mean()
    time, values = column(run, "time"), _values(run, name)
    during = values[(time > BEGIN + 6.0) & (time < END)]
    after = values[time > END + 6.0]
    first, last = (float(p.mean() - plain) if len(p) else np.nan for p in (during, after))
    return first, last


def _values(run: Result, name: str) -> Any:
    """Return a column of the trace, or "bend": the spine's angle, rad."""
    return np.array(run["bend"]) if name == "bend" else column(run, name)


def claims(job: Job, name: str, least: float, what: str, results: Results) -> list[Claim]:
    """Judge that a style comes and goes, without a fall.

    Args:
        job: The walk.
        name: Column that shows it.
        least: Change that shows it, with its sign.
        what: What the thesis says.
        results: All runs.
    """
    run = results[job]
    during, after = _change(job, results, name)
    shows = during / least >= 1.0 and abs(after) <= 0.3 * abs(during)
    ours = f"mean {name} changes by {during:+.3f}, and by {after:+.3f} afterwards; "
    return [
        Claim(
            what,
            ours + (f"{run['steps']} steps" if walked(run) else f"fell after {run['steps']} steps"),
            f"walks; {least:+g} or more, and 30 % of it or less afterwards",
            bool(walked(run) and shows),
        )
    ]


def _figure(name: str, title: str, statement: str, job: Job, *judge: Any) -> Figure:
    return Figure(
        name,
        title,
        statement,
        lambda quick: [job, PLAIN],
        partial(draw, job),
        partial(claims, job, *judge),
        size=(8.0, 5.0),
    )


FIGURES = (
    _figure(
        "5.16",
        "Bent-knee walking",
        "The bent-knee perturbation comes in smoothly over 18 steps, to a scaling of 1.",
        KNEES,
        "z",
        -0.01,
        "walks with bent knees, smoothly in and out",
    ),
    _figure(
        "5.18",
        "Bent-over walking",
        "A bend at waist and torso; the arms hang.",
        OVER,
        "bend",
        0.5,
        "walks bent over, smoothly in and out",
    ),
    _figure(
        "5.20",
        "Ducking",
        "Bent knees, bent over and a bent neck compose to ducking under an obstacle, in and out.",
        DUCK,
        "bend",
        0.5,
        "ducks and comes up again in one walk",
    ),
)
