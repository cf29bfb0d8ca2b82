"""Algorithm V-1, option C: a fall that nothing can prevent."""

from typing import Any

import numpy as np

from windup.tools.reproduce.kenwright.jobs import AROUND, FOUR, cell, fall
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Results

ALL = AROUND[::2]
SOFT = 0.3


def _falls(quick: bool, protect: bool) -> list[Job]:
    directions = FOUR if quick else ALL
    return [fall(direction, protect=protect) for direction in directions]


def jobs(quick: bool) -> list[Job]:
    """Return falls with protection, and stiff ones."""
    return _falls(quick, True) + _falls(quick, False)


def trunk(run: dict[str, Any]) -> float:
    """Return how fast the trunk or the head met the floor, m/s."""
    return float(max(run["torso_impact_m_s"], run["head_impact_m_s"]))


def claims(results: Results) -> list[Claim]:
    """Judge the arms, the servos, and the trunk."""
    soft, stiff = (cell(_falls(False, protect), results) for protect in (True, False))
    toward = [run["reach"] for run in soft if run["reach"] is not None]
    theirs = [run["reach"] for run in stiff if run["reach"] is not None]
    worst = max(map(trunk, soft)) / max(max(map(trunk, stiff)), 1e-9)
    return [
        Claim(
            "the arms go in the direction of the fall",
            f"at the first touch the farther forearm is {1e3 * np.mean(toward):.0f} mm from the "
            f"trunk toward the fall in the mean, {1e3 * np.mean(theirs):.0f} mm in a stiff one",
            "farther than in a stiff fall",
            bool(np.mean(toward) > np.mean(theirs)),
        ),
        Claim(
            "it does not turn into a limp ragdoll",
            f"{sum(run['powered'] for run in soft)} of {len(soft)} hold their servos on until "
            "they touch the floor",
            "all",
            all(run["powered"] for run in soft),
        ),
        Claim(
            "the trunk's worst impact is softer than a stiff fall's",
            f"{100 * (1.0 - worst):.0f} % slower",
            f"{100 * SOFT:.0f} % or more",
            worst <= 1.0 - SOFT,
            own=True,
        ),
    ]


def draw(canvas: Any, results: Results) -> None:
    """Draw the impacts over the direction."""
    axis = canvas.subplots()
    for protect, label in ((True, "protected"), (False, "stiff")):
        runs = cell(_falls(False, protect), results)
        axis.plot([r["directions"][0] for r in runs], [*map(trunk, runs)], "o-", label=label)
    axis.set(xlabel="fall toward [deg]", ylabel="trunk or head meets the floor [m/s]")
    axis.legend()


def table(results: Results) -> list[DataTable]:
    """Return one row a fall."""
    rows = [
        [
            "protected" if protect else "stiff",
            f"{run['directions'][0]:g}",
            f"{trunk(run):.2f}",
            f"{100 * run['peak_load']:.0f}",
            "" if run["reach"] is None else f"{1e3 * run['reach']:.0f}",
        ]
        for protect in (True, False)
        for run in cell(_falls(False, protect), results)
    ]
    header = ["", "fall [deg]", "impact [m/s]", "peak load [% of stall]", "forearm [mm]"]
    return [DataTable("", header, rows)]


FIGURES = (
    Figure(
        "C",
        "A fall that nothing can prevent",
        "Where the force is too much, the character must fall: it takes protective actions, puts "
        "its arms in the direction of the fall, and does not turn into a limp ragdoll.",
        jobs,
        draw,
        claims,
        table,
    ),
)
