"""Section IV-A: circles for the feet, a capsule for both, and places where no foot may go."""

from typing import Any

import numpy as np

from windup.tools.reproduce.kenwright.jobs import AROUND, FOUR, cell, count, push
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Results

IMPULSE = 1.8  # N s
SUPPORTS = ("hull", "capsule")
FEW = 0.1
ZONE = (0.13, 0.07, 0.06, 0.08)  # before one foot: its middle, its widths along x and y, m
TOWARD = (-30.0, -15.0, 0.0, 15.0, 30.0)


def _around(quick: bool, support: str) -> list[Job]:
    return [push(IMPULSE, [way], support=support) for way in (FOUR if quick else AROUND)]


def jobs(quick: bool) -> list[Job]:
    """Return pushes met with both kinds of support."""
    return [job for support in SUPPORTS for job in _around(quick, support)]


def claims(results: Results) -> list[Claim]:
    """Judge whether circles do as well as the soles' outline."""
    hull, capsule = (cell(_around(False, support), results) for support in SUPPORTS)
    good = [sum(run["survived"] for run in runs) for runs in (hull, capsule)]
    steps = [sum(run["steps"] for run in runs) for runs in (hull, capsule)]
    return [
        Claim(
            "circles and a capsule are a valid support region",
            f"with circles {count(capsule)} stay up ({steps[1]} steps), with the hull of the "
            f"soles {count(hull)} ({steps[0]} steps)",
            "no more than one in ten fewer",
            good[1] >= good[0] - FEW * len(hull),
        )
    ]


def draw(canvas: Any, results: Results) -> None:
    """Draw how many steps each push takes with either region."""
    axis = canvas.subplots()
    for support, mark in zip(SUPPORTS, "os", strict=True):
        runs = cell(_around(False, support), results)
        for survived, fill in ((True, "full"), (False, "none")):
            some = [run for run in runs if run["survived"] == survived]
            at = [run["directions"][0] for run in some]
            label = f"{support}, {'stands' if survived else 'falls'}"
            axis.plot(at, [run["steps"] for run in some], mark, fillstyle=fill, label=label)
    axis.set(xlabel="push toward [deg]", ylabel="steps")
    axis.legend(fontsize="small")


def _zone(side: int) -> str:
    x, y, wide, deep = ZONE
    return f"{x:g},{side * y:g},{wide:g},{deep:g}"


def hole_jobs(quick: bool) -> list[Job]:
    """Return pushes toward ground that is forbidden before one foot, and free."""
    toward = TOWARD[1:4] if quick else TOWARD
    sides = (1,) if quick else (1, -1)
    free = [push(IMPULSE, [way]) for way in toward]
    return free + [push(IMPULSE, [way], forbid=[_zone(side)]) for side in sides for way in toward]


def claims_hole(results: Results) -> list[Claim]:
    """Judge that no foot comes down there, and what that costs."""
    runs = list(results.values())
    kept = [run for run in runs if "landings" in run]
    free = [run for run in runs if "landings" not in run]
    fell = sum(run["landed_forbidden"] for run in kept)
    falls = sum(len(run["landings"]) for run in kept)
    shares = [np.mean([run["survived"] for run in some]) for some in (kept, free)]
    return [
        Claim(
            "a foot is never placed in a hole: the next closest point is taken",
            f"{fell} of {falls} footfalls touch the forbidden ground",
            "none",
            fell == 0 if falls else None,
        ),
        Claim(
            "the step that was decided anew balances all the same",
            f"{count(kept)} stay up with the hole, {count(free)} without",
            "no more than one in ten fewer",
            bool(shares[0] >= shares[1] - FEW),
        ),
    ]


def draw_hole(canvas: Any, results: Results) -> None:
    """Draw from above where the feet came down, and the forbidden ground."""
    axis = canvas.subplots()
    for side in (1, -1):
        x, y, wide, deep = ZONE
        corner = (x - 0.5 * wide, side * y - 0.5 * deep)
        runs = [results[job] for job in results if job.options.get("forbid") == [_zone(side)]]
        color = "tab:blue" if side > 0 else "tab:orange"
        if runs:
            patch = {"alpha": 0.2, "color": color, "linewidth": 0}
            axis.fill_between([corner[0], corner[0] + wide], corner[1], corner[1] + deep, **patch)
        falls = [fall for run in runs for fall in run["landings"]]
        axis.plot([f["x"] for f in falls], [f["y"] for f in falls], "o", color=color)
    axis.set(xlabel="x [m]", ylabel="y [m]")
    axis.set_aspect("equal", adjustable="datalim")


def table_hole(results: Results) -> list[DataTable]:
    """Return one row a run."""
    rows = []
    for job, run in results.items():
        falls = run.get("landings", [])
        where = ", ".join(f"{f['foot'][0]} ({f['x']:.2f}, {f['y']:.2f})" for f in falls)
        rows.append(
            [
                " ".join(job.options.get("forbid", ["free"])),
                f"{run['directions'][0]:g}",
                "stands" if run["survived"] else "fell",
                str(run["steps"]),
                where,
            ]
        )
    return [DataTable("", ["forbidden", "push [deg]", "", "steps", "feet come down [m]"], rows)]


FIGURES = (
    Figure(
        "2",
        "Circles and a capsule",
        "A circle stands for the support of one foot, a capsule for that of two; simple to "
        "compute, and good enough.",
        jobs,
        draw,
        claims,
    ),
    Figure(
        "IV-A4",
        "Places where no foot may go",
        "Feet never step on each other or into a hole: the next closest point is taken, and if "
        "that does not balance, it is decided again.",
        hole_jobs,
        draw_hole,
        claims_hole,
        table_hole,
        (7.0, 5.0),
    ),
)
