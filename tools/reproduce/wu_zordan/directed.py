"""Figure 1 and section 6: directed steps, on the feet and in a handstand."""

from typing import Any

import numpy as np

from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results
from windup.tools.reproduce.wu_zordan.jobs import cell, turn, walk

CLOSE = 0.03  # m
STEPS, SEEDS = 20, 6
TURN = turn("human", 6, 30.0)
HANDS, HAND_SEEDS = 6, 6


def _feet(quick: bool) -> list[Job]:
    return [walk("human", STEPS, seed) for seed in range(1 if quick else SEEDS)]


def _hands(quick: bool) -> list[Job]:
    return [walk("human_handstand", HANDS, seed) for seed in range(1 if quick else HAND_SEEDS)]


def off(runs: list[Result]) -> float:
    """Return how far the foot that came down farthest from its place is from it, m."""
    return max((run["largest_away_m"] or 0.0 for run in runs), default=np.nan)


def _followed(runs: list[Result], what: str) -> Claim:
    good = [run for run in runs if run["stepped"] == run["steps"] and off([run]) <= CLOSE]
    return Claim(
        f"the character follows the footprints with its {what}",
        f"{len(good)} of {len(runs)} walks of {runs[0]['steps']} random steps put every one "
        f"within {1e3 * CLOSE:.0f} mm; the farthest is {1e3 * off(runs):.0f} mm off",
        f"all, within {1e3 * CLOSE:.0f} mm",
        len(good) == len(runs),
    )


def claims(results: Results) -> list[Claim]:
    """Judge footprints and the turn on the spot."""
    turned = results[TURN]
    return [
        _followed(cell(_feet(False), results), "feet"),
        Claim(
            "a small number of directed steps reorients it",
            f"{turned['turned']:g} degrees in {turned['stepped']} of {turned['steps']} steps, "
            f"{turned['largest_turned_deg'] or np.nan:.1f} degrees off at most",
            "all steps taken, each within 5 degrees",
            turned["stepped"] == turned["steps"] and (turned["largest_turned_deg"] or 0.0) <= 5.0,
        ),
    ]


def draw(jobs: Any, canvas: Any, results: Results) -> None:
    """Draw how far each foot came down from its place."""
    axis = canvas.subplots()
    for run in cell(jobs(False), results):
        wanted = np.array([[fall["wanted"][k] for k in "xy"] for fall in run["falls"]])
        place = np.array([[fall["place"][k] for k in "xy"] for fall in run["falls"]])
        if len(wanted):
            axis.plot(*wanted.T, "s", color="tab:red", markersize=8, fillstyle="none")
            axis.plot(*place.T, ".", color="tab:blue")
    axis.set(xlabel="forward of the foot that stays [m]", ylabel="to its left [m]")
    axis.set_title("footprints (red) and where the soles came down (blue)")
    axis.set_aspect("equal", adjustable="datalim")


def table(jobs: Any, results: Results) -> list[DataTable]:
    """Return one row a walk."""
    rows = [
        [
            f"{run['stepped']} of {run['steps']}",
            f"{1e3 * off([run]):.1f}",
            f"{run['largest_turned_deg'] or 0.0:.1f}",
            f"{run['seconds']:.1f}",
        ]
        for run in cell(jobs(False), results)
    ]
    return [DataTable("", ["steps", "farthest off [mm]", "[deg]", "time [s]"], rows)]


def _foot_jobs(quick: bool) -> list[Job]:
    return [*_feet(quick), TURN]


FIGURES = (
    Figure(
        "1",
        "Directed steps",
        "A series of footsteps is followed; a few directed steps reorient and position the "
        "character.",
        _foot_jobs,
        lambda canvas, results: draw(_feet, canvas, results),
        claims,
        lambda results: table(_foot_jobs, results),
        (7.0, 5.0),
    ),
    Figure(
        "handstand",
        "Steps in a handstand",
        "Only goals are controlled and no parameter of a character is set: the same controller "
        "makes it take steps in a handstand.",
        _hands,
        lambda canvas, results: draw(_hands, canvas, results),
        lambda results: [_followed(cell(_hands(False), results), "hands")],
        lambda results: table(_hands, results),
        (7.0, 5.0),
    ),
)
