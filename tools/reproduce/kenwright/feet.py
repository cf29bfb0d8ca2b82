"""Algorithm V-1, option A: small pushes are balanced with the feet alone."""

from typing import Any

import numpy as np

from windup.tools.reproduce.kenwright.jobs import AROUND, FOUR, cell, count, push
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Results

SMALL = 0.7  # N s
GRID = (1.4, 1.6, 1.8, 2.0)  # N s
WAYS = ("hold", "feet")


def _small(quick: bool) -> list[Job]:
    return [push(SMALL, [direction]) for direction in (FOUR if quick else AROUND)]


def _grid(quick: bool, way: str) -> list[Job]:
    around, impulses = (FOUR, GRID[2:3]) if quick else (AROUND[::2], GRID)
    # Both stand in the same pose, so that only the feet's pressure differs.
    return [push(impulse, [way_to], way=way) for impulse in impulses for way_to in around]


def jobs(quick: bool) -> list[Job]:
    """Return small pushes, and larger ones met stiffly and by the feet's pressure."""
    return _small(quick) + [job for way in WAYS for job in _grid(quick, way)]


def share(way: str, results: Results) -> float:
    """Return the part of the larger pushes that a way to meet them survives."""
    runs = cell(_grid(False, way), results)
    return float(np.mean([run["survived"] for run in runs]))


def claims(results: Results) -> list[Claim]:
    """Judge the small pushes, and what pressing with the feet is worth."""
    small = cell(_small(False), results)
    steps = sum(run["steps"] for run in small)
    feet, hold = share("feet", results), share("hold", results)
    return [
        Claim(
            "small disturbances are corrected by ankle torque, without a step",
            f"{count(small)} pushes of {SMALL:g} N s stay up, with {steps} steps",
            "all, and no step",
            all(run["survived"] for run in small) and steps == 0,
        ),
        Claim(
            "the feet's support region is what makes that possible",
            f"pressing with the feet survives {100 * feet:.0f} %, the same pose held stiffly "
            f"{100 * hold:.0f} % of {len(cell(_grid(False, 'hold'), results))} larger pushes",
            "more than held stiffly",
            feet > hold,
        ),
    ]


def draw(canvas: Any, results: Results) -> None:
    """Draw how many of the larger pushes each way survives."""
    axis = canvas.subplots()
    for way in WAYS:
        shares = []
        for impulse in GRID:
            runs = cell(_grid(False, way), results)
            of_these = [run["survived"] for run in runs if run["impulse"] == impulse]
            shares.append(100.0 * np.mean(of_these) if of_these else np.nan)
        axis.plot(GRID, shares, marker="o", label=way)
    axis.set(xlabel="impulse [N s]", ylabel="survived [%]", ylim=(-5, 105))
    axis.legend()


def table(results: Results) -> list[DataTable]:
    """Return how many pushes of each impulse each way survives."""
    rows = []
    for way in WAYS:
        for impulse in GRID:
            runs = [r for r in cell(_grid(False, way), results) if r["impulse"] == impulse]
            if runs:
                rows.append([way, f"{impulse:g}", count(runs)])
    return [DataTable("", ["way", "impulse [N s]", "survived"], rows)]


FIGURES = (
    Figure(
        "A",
        "Balance with the feet",
        "A small push needs no step: a torque at the ankles corrects it, because the feet have a "
        "support region.",
        jobs,
        draw,
        claims,
        table,
    ),
)
