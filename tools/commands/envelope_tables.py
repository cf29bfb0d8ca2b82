"""What `windup push --envelope` prints: the largest impulses, and how each way did on the grid."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from rich.table import Table

from windup.tools.assembly.stepping import FEET, HOLD
from windup.tools.behaviours.push_edge import Edge

Edges = Mapping[float, Edge]


def largest_table(directions: Sequence[float], largest: Mapping[str, Sequence[float]]) -> Table:
    """Return the table of the largest impulses, N s, of each way in each direction, degrees."""
    table = Table("toward", title="largest impulse survived with no fall below it, N s")
    for way in largest:
        table.add_column(way, justify="right")
    for number, direction in enumerate(directions):
        table.add_row(f"{direction:g}", *(f"{row[number]:.2f}" for row in largest.values()))
    table.add_section()
    table.add_row("worst", *(f"{min(row):.2f}" for row in largest.values()))
    table.add_row("mean", *(f"{np.mean(row):.2f}" for row in largest.values()))
    return table


def summarise(edges: Edges, ways: Mapping[str, Edges]) -> dict[str, Any]:
    """Return how one way did.

    Args:
        edges: What was found, by direction, degrees.
        ways: The same of all ways: a step is needless where the feet alone, or a stiff pose where
            these were not tried, survive as much.
    """
    without = ways.get(FEET, ways.get(HOLD))
    trials = [(way, row) for way, edge in edges.items() for row in edge.grid]
    good = [row for _, row in trials if row["survived"]]
    needless = sum(
        row["steps"] > 0 and row["impulse"] <= without[way].impulse
        for way, row in trials
        if without is not None
    )
    return {
        "mean": float(np.mean([edge.impulse for edge in edges.values()])),
        "grid": len(trials),
        "survived": len(good),
        "steps": _mean(row["steps"] for row in good),
        "needless": needless,
        "settling_s": _mean(row["settling_s"] for row in good),
        "astray_m": _mean(row["astray_m"] for row in good),
    }


def summary_table(summaries: Mapping[str, Mapping[str, Any]]) -> Table:
    """Return the table of what `summarise` found for each way."""
    table = Table(title="on the grid of impulses; means of the trials that were survived")
    for name in ("way", "survived", "steps", "pushes with needless steps", "still after", "astray"):
        table.add_column(name, justify="left" if name == "way" else "right")
    for way, row in summaries.items():
        table.add_row(
            way,
            f"{row['survived']} of {row['grid']}",
            f"{row['steps']:.1f}",
            str(row["needless"]),
            f"{row['settling_s']:.2f} s",
            f"{1000 * row['astray_m']:.0f} mm",
        )
    return table


def _mean(values: Any) -> float:
    """Return the mean, 0 of nothing."""
    found = [float(value) for value in values]
    return float(np.mean(found)) if found else 0.0
