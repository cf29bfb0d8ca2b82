"""Section IV-B and figure 3: feet take their heading from the body."""

from typing import Any

import numpy as np

from windup.hal.geometry.angles import wrapped
from windup.hal.joints import Array
from windup.tools.reproduce.kenwright.jobs import push
from windup.tools.reproduce.kenwright.pushes import FACING, facing
from windup.tools.reproduce.kenwright.recorder import column
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results

IMPULSE = 1.8  # N s, at a shoulder: 0.11 N m s about the vertical
SHOULDERS = ("l_sho_pitch_link", "r_sho_pitch_link")
TOWARD = (0.0, 180.0)
SEEDS = 3
ALIKE = 10.0  # degrees
FEET = ("left", "right")


def jobs(quick: bool) -> list[Job]:
    """Return pushes at the shoulders, forward and backward."""
    seeds = range(1 if quick else SEEDS)
    toward = TOWARD[:1] if quick else TOWARD
    return [
        push(IMPULSE, [way], seed, body=body)
        for body in SHOULDERS
        for way in toward
        for seed in seeds
    ]


def apart(foot: Array, trunk: Array) -> Array:
    """Return how far a foot's heading is from the trunk's, degrees, from both in rad."""
    return np.degrees(wrapped(foot - trunk))


def landed(result: Result) -> list[float]:
    """Return, of each step that a fall forced, how far the foot's heading was from the trunk's."""
    phase, time, found = column(result, "phase"), column(result, "time"), []
    for begun in result["begun"]:
        row = int(np.searchsorted(time, begun["time"]))
        while row < len(phase) - 1 and phase[row] == 1.0:
            row += 1
        foot = column(result, f"{FEET[int(begun['foot'])]}.yaw")
        found.append(float(apart(foot, column(result, "yaw"))[row]))
    return found


def claims(results: Results) -> list[Claim]:
    """Judge that the body turns, its feet with it, and that they end as it faces."""
    runs = [run for run in results.values() if run["survived"]]
    turned = [float(np.degrees(np.ptp(column(run, "yaw")))) for run in results.values()]
    steps = [away for run in runs for away in landed(run)]
    alike = sum(abs(away) <= ALIKE for away in steps)
    ends = [facing(run) for run in runs]
    return [
        Claim(
            "a push that turns the body is stood",
            f"{len(runs)} of {len(results)} stay up; the body turns by {np.median(turned):.0f} "
            "degrees in the middle",
            "all",
            len(runs) == len(results),
        ),
        Claim(
            "the orientation of the stepping foot is the pelvis'",
            f"{alike} of {len(steps)} steps land within {ALIKE:g} degrees of the trunk's heading",
            "all",
            alike == len(steps) if steps else None,
        ),
        Claim(
            "corrective steps match the feet to the direction of the pelvis",
            f"at the end at most {max(ends, default=np.nan):.0f} degrees off",
            f"all within {FACING:g} degrees",
            all(away <= FACING for away in ends) if ends else None,
        ),
    ]


def draw(canvas: Any, results: Results) -> None:
    """Draw the headings of trunk and feet of the first runs over time."""
    for axis, run in zip(np.ravel(canvas.subplots(1, 2)), results.values(), strict=False):
        time = column(run, "time")
        axis.plot(time, np.degrees(column(run, "yaw")), "k", label="trunk")
        for foot in FEET:
            axis.plot(time, np.degrees(column(run, f"{foot}.yaw")), label=f"{foot} foot")
        axis.set(xlabel="time [s]", ylabel="heading [deg]")
    axis.legend(fontsize="small")


def table(results: Results) -> list[DataTable]:
    """Return one row a run."""
    rows = [
        [
            str(job.options["body"]),
            f"{run['directions'][0]:g}",
            "stands" if run["survived"] else "fell",
            f"{run['steps']} and {run['comfort_steps']}",
            f"{np.degrees(np.ptp(column(run, 'yaw'))):.0f}",
            f"{facing(run):.0f}" if run["survived"] else "",
        ]
        for job, run in results.items()
    ]
    header = [
        "pushed at",
        "toward [deg]",
        "",
        "steps, comfort steps",
        "turns by [deg]",
        "ends [deg]",
    ]
    return [DataTable("", header, rows)]


FIGURES = (
    Figure(
        "3",
        "Feet follow the body",
        "The feet always take the body as the reference of their orientation; when it turns, they "
        "take corrective steps until they face as the pelvis does.",
        jobs,
        draw,
        claims,
        table,
    ),
)
