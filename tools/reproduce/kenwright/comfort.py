"""Algorithm V-1, option B 2, and figure 3: steps back to a comfortable stance."""

from typing import Any

import numpy as np

from windup.tools.reproduce.kenwright.jobs import AROUND, FOUR, STEP, cell, count, push
from windup.tools.reproduce.kenwright.pushes import FACING, RELAXED, facing, relaxed
from windup.tools.reproduce.kenwright.recorder import apart, column
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results

IMPULSE = 1.8  # N s
FAR = 0.02  # m


def jobs(quick: bool) -> list[Job]:
    """Return pushes that need steps, all around."""
    return [push(IMPULSE, [direction], way=STEP) for direction in (FOUR if quick else AROUND)]


def before(result: Result) -> float:
    """Return how far a foot was from its place when the last step to prevent a fall ended, m."""
    phase, gap = column(result, "phase"), apart(result)
    ended = np.flatnonzero(phase == 1.0)
    row = gap[min(int(ended[-1]) + 1, len(gap) - 1)] if len(ended) else gap[-1]
    return float(np.linalg.norm(row - gap[0]))


def claims(results: Results) -> list[Claim]:
    """Judge that those who stepped come back."""
    runs = cell(jobs(False), results)
    stepped = [run for run in runs if run["survived"] and before(run) > FAR]
    back = [run for run in stepped if run["comfort_steps"] > 0]
    eased = sum(relaxed(run) for run in stepped)
    away = [1e3 * run["astray_m"] for run in stepped]
    turned = [facing(run) for run in stepped]
    return [
        Claim(
            "after a step the feet take another one to a more comfortable place",
            f"{len(back)} of {len(stepped)} runs whose feet ended more than {1e3 * FAR:.0f} mm "
            "away take comfort steps",
            "all",
            len(back) == len(stepped) if stepped else None,
        ),
        Claim(
            "the feet end in their comfort region",
            f"{eased} of {len(stepped)}, at most {max(away, default=np.nan):.0f} mm and "
            f"{max(turned, default=np.nan):.0f} degrees from the stance",
            f"all within {1e3 * RELAXED:.0f} mm and {FACING:g} degrees",
            eased == len(stepped) if stepped else None,
        ),
        Claim(
            "comfort steps are taken from a stable state: they fell nobody",
            f"{count(runs)} stay up",
            "all",
            all(run["survived"] for run in runs),
        ),
    ]


def draw(canvas: Any, results: Results) -> None:
    """Draw how far the feet are from their places after the steps and at the end."""
    axis = canvas.subplots()
    for run in cell(jobs(False), results):
        if run["survived"]:
            at = run["directions"][0]
            axis.plot(at, 1e3 * before(run), "o", color="tab:red")
            axis.plot(at, 1e3 * run["astray_m"], "o", color="tab:green")
    axis.axhline(1e3 * RELAXED, color="k", linewidth=0.8, linestyle=":")
    axis.set(xlabel="push toward [deg]", ylabel="feet from their places [mm]")
    axis.set_title("after the last step (red) and at the end (green)")


def table(results: Results) -> list[DataTable]:
    """Return one row a direction."""
    rows = [
        [
            f"{run['directions'][0]:g}",
            "stands" if run["survived"] else "fell",
            str(run["steps"]),
            str(run["comfort_steps"]),
            f"{1e3 * before(run):.0f}",
            f"{1e3 * run['astray_m']:.0f}" if run["survived"] else "",
            f"{facing(run):.0f}" if run["survived"] else "",
        ]
        for run in cell(jobs(False), results)
    ]
    header = ["push [deg]", "", "steps", "comfort steps", "off [mm]", "at the end [mm]", "[deg]"]
    return [DataTable("", header, rows)]


FIGURES = (
    Figure(
        "B2",
        "Comfort steps",
        "Once stable, the character takes further steps until its feet are in their comfort "
        "region and face the same direction as the pelvis.",
        jobs,
        draw,
        claims,
        table,
    ),
)
