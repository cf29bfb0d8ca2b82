"""Algorithm V-1, option B 1, and figure 4: a step prevents a fall."""

from typing import Any

import numpy as np

from windup.tools.reproduce.kenwright.jobs import AROUND, FOUR, STEP, cell, count, push
from windup.tools.reproduce.kenwright.recorder import column
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results

LARGE = (1.8, 2.0)  # N s
PERIOD = 4.0  # ms, of a tick at 250 Hz
AHEAD = (0.0, 180.0)
CLEAR = 0.05  # of the weight, more than half on one foot


def _large(quick: bool, way: str) -> list[Job]:
    around = FOUR if quick else AROUND
    impulses = LARGE[:1] if quick else LARGE
    return [push(impulse, [way_to], way=way) for impulse in impulses for way_to in around]


def jobs(quick: bool) -> list[Job]:
    """Return large pushes, met with steps and without."""
    return _large(quick, STEP) + _large(quick, "feet")


def claims(results: Results) -> list[Claim]:
    """Judge that steps save what the feet alone cannot, and which foot steps."""
    step, feet = (cell(_large(False, way), results) for way in (STEP, "feet"))
    ahead = [run for run in step if run["directions"][0] in AHEAD]
    begun = [first for run in step for first in run["begun"][:1]]
    begun = [first for first in begun if abs(first["share"] - 0.5) > CLEAR]
    light = sum(first["share"] > 0.5 for first in begun)
    ticks = [run["tick_ms"]["p50"] for run in step]
    return [
        Claim(
            "a larger push is met by a corrective step",
            f"{count(step)} stay up with steps, {count(feet)} with the feet alone",
            "more with steps",
            sum(run["survived"] for run in step) > sum(run["survived"] for run in feet),
        ),
        Claim(
            "forward and backward the step is needed",
            f"{sum(run['steps'] > 0 for run in ahead)} of {len(ahead)} step",
            "all",
            all(run["steps"] > 0 for run in ahead),
        ),
        Claim(
            "the foot that bears more weight stays",
            f"{light} of {len(begun)} first steps are of the foot that bears less, where one "
            "clearly does",
            "nine of ten",
            light >= 0.9 * len(begun) if begun else None,
        ),
        Claim(
            "it is fit for real time",
            f"a tick takes {np.median(ticks):.2f} ms in the middle",
            f"below the {PERIOD:g} ms of a tick at 250 Hz",
            bool(np.median(ticks) < PERIOD),
        ),
    ]


def draw(canvas: Any, results: Results) -> None:
    """Draw where the feet and the weight went, from above, for a few directions."""
    some = [run for run in cell(_large(False, STEP), results) if run["directions"][0] in FOUR]
    for axis, run in zip(np.ravel(canvas.subplots(1, 4)), some, strict=False):
        for foot, color in (("left", "tab:blue"), ("right", "tab:orange")):
            axis.plot(column(run, f"{foot}.x"), column(run, f"{foot}.y"), color=color, label=foot)
        axis.plot(column(run, "com.x"), column(run, "com.y"), "k", label="weight")
        axis.set(title=f"{run['impulse']:g} N s, {run['directions'][0]:g} deg", xlabel="x [m]")
        axis.set_aspect("equal", adjustable="datalim")


def table(results: Results) -> list[DataTable]:
    """Return how many pushes are survived, by impulse."""
    rows = []
    for way in (STEP, "feet"):
        for impulse in LARGE:
            runs = [run for run in cell(_large(False, way), results) if run["impulse"] == impulse]
            if runs:
                rows.append([way, f"{impulse:g}", count(runs), str(sum(r["steps"] for r in runs))])
    return [DataTable("", ["met by", "impulse [N s]", "survived", "steps"], rows)]


def paths(result: Result) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the swing of each step that a fall forced: part of its time, and height of it, m."""
    phase, time = column(result, "phase"), column(result, "time")
    found = []
    for begun in result["begun"]:
        first = int(np.searchsorted(time, begun["time"]))
        last = first
        while last < len(phase) and phase[last] == 1.0:
            last += 1
        if last - first > 5:
            heights = column(result, ("left.z", "right.z")[int(begun["foot"])])[first:last]
            found.append((np.linspace(0.0, 1.0, last - first), heights - heights[0]))
    return found


def claims_path(results: Results) -> list[Claim]:
    """Judge that the swing foot shoots up and sinks slowly."""
    swings = [path for run in results.values() for path in paths(run)]
    tops = [part[int(np.argmax(height))] for part, height in swings]
    early = sum(top < 0.5 for top in tops)
    return [
        Claim(
            "the foot shoots up early and sinks toward its target",
            f"in {early} of {len(tops)} swings the highest point comes in the first half, at "
            f"{100 * np.median(tops) if tops else np.nan:.0f} % of the time in the middle",
            "in most",
            early > 0.5 * len(tops) if tops else None,
        )
    ]


def draw_path(canvas: Any, results: Results) -> None:
    """Draw the height of each swing over its time."""
    axis = canvas.subplots()
    for run in results.values():
        for part, height in paths(run):
            axis.plot(100.0 * part, 1e3 * height, color="tab:blue", alpha=0.4)
    axis.set(xlabel="time of the swing [%]", ylabel="sole above its start [mm]")


FIGURES = (
    Figure(
        "B1",
        "A step to prevent a fall",
        "Where the feet's pressure does not suffice, a corrective step does: with the foot that "
        "bears less weight, to where the inverted pendulum says; all of it cheap to compute.",
        jobs,
        draw,
        claims,
        table,
        (12.0, 4.0),
    ),
    Figure(
        "4",
        "The way of the swing foot",
        "In people the foot shoots up and sinks exponentially toward its target; a curve whose "
        "peak is early does likewise.",
        lambda quick: _large(quick, STEP),
        draw_path,
        claims_path,
        size=(7.0, 4.0),
    ),
)
