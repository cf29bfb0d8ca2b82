"""Section V: the inverted pendulum keeps walking, or halts, in any direction."""

from math import degrees, radians
from typing import Any

import numpy as np

from windup.hal.geometry.angles import wrapped
from windup.tools.reproduce.kenwright.jobs import stride
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results

SPEED = 0.1  # m/s
HEADINGS = (0.0, 45.0, 90.0, 135.0, 180.0, -90.0)
SLOW, ASTRAY = 0.1, 15.0  # part of the speed, with 1 cm/s more, and degrees
TURN = 60.0
SEEDS = 3


def _headings(quick: bool) -> list[Job]:
    headings, seeds = (HEADINGS[1:3], 1) if quick else (HEADINGS, SEEDS)
    return [stride(heading=way, seconds=6.0, seed=k) for way in headings for k in range(seeds)]


def _grounds(quick: bool) -> list[Job]:
    seeds = 1 if quick else SEEDS
    grounds = [{"slope": 4.0}, {"slope": -4.0}, {"stairs": 0.01}, {"strips": 0.01}]
    grounds = grounds[1:3] if quick else grounds
    return [stride(seconds=12.0, seed=k, **ground) for ground in grounds for k in range(seeds)]


def _turns(quick: bool) -> list[Job]:
    then = [f"4,{SPEED:g},{TURN:g},{TURN:g}", f"10,0,{TURN:g},{TURN:g}"]
    return [stride(then=then, seconds=11.0, seed=k) for k in range(1 if quick else SEEDS)]


def jobs(quick: bool) -> list[Job]:
    """Return walks in all directions, with a change of it, and over other ground."""
    return _headings(quick) + _turns(quick) + _grounds(quick)


def _split(results: Results) -> tuple[list[Result], list[Result], list[Result]]:
    """Return those on level ground straight on, those that turn, those on other ground."""
    rough = [r for job, r in results.items() if set(job.options) & {"slope", "strips", "stairs"}]
    turning = [r for job, r in results.items() if "then" in job.options]
    level = [r for r in results.values() if r not in rough and r not in turning]
    return level, turning, rough


def _off(leg: dict[str, Any]) -> float:
    """Return how far the measured heading is from the ordered one, degrees."""
    return abs(degrees(wrapped(radians(leg["measured_heading"] - leg["heading"]))))


def claims(results: Results) -> list[Claim]:
    """Judge walking, its direction, its halt, and other ground."""
    level, turning, rough = _split(results)
    return [
        *_straight(level),
        _halts(level + turning),
        _turning(turning),
        Claim(
            "uneven terrain: slopes and stairs",
            f"{_good(rough)} of {len(rough)} walks on 4 degrees up and down and over 1 cm stay up",
            "all",
            _good(rough) == len(rough),
        ),
    ]


def _straight(level: list[Result]) -> list[Claim]:
    """Judge speed and direction of walks straight on."""
    legs = [leg for run in level for leg in run["legs"] if leg["measured_speed"] is not None]
    speeds = [leg["measured_speed"] for leg in legs]
    off = [_off(leg) for leg in legs]
    return [
        Claim(
            "a persistent stable walk in any direction",
            f"{_good(level)} of {len(level)} walks stay up; {min(speeds, default=np.nan):.3f} to "
            f"{max(speeds, default=np.nan):.3f} m/s where {SPEED:g} is ordered",
            f"all stay up, within {100 * SLOW:.0f} % and 1 cm/s",
            _good(level) == len(level)
            and all(abs(v - SPEED) <= SLOW * SPEED + 0.01 for v in speeds),
        ),
        Claim(
            "the direction is the one that is wanted",
            f"at most {max(off, default=np.nan):.0f} degrees off",
            f"{ASTRAY:g} degrees or less",
            all(away <= ASTRAY for away in off) if off else None,
        ),
    ]


def _halts(runs: list[Result]) -> Claim:
    return Claim(
        "it halts whenever it should",
        f"{_good(runs)} of {len(runs)} stand still on both feet at the end",
        "all",
        _good(runs) == len(runs),
    )


def _turning(runs: list[Result]) -> Claim:
    """Judge walks that change their direction on the way."""
    late = [run["legs"][1] for run in runs if run["legs"][1]["measured_speed"] is not None]
    new = [_off(leg) for leg in late]
    faced = [abs(run["turned_deg"] - TURN) for run in runs]
    return Claim(
        "a new direction is taken on the way, and the feet turn with the body",
        f"{max(new, default=np.nan):.0f} degrees off the new direction at most; the body ends "
        f"{max(faced, default=np.nan):.0f} degrees off at most",
        f"{ASTRAY:g} degrees or less",
        all(away <= ASTRAY for away in new + faced) if new else None,
    )


def _good(runs: list[Result]) -> int:
    return sum(bool(run["good"]) for run in runs)


def draw(canvas: Any, results: Results) -> None:
    """Draw the ways from above."""
    axis = canvas.subplots()
    for job, run in results.items():
        if not set(job.options) & {"slope", "strips", "stairs"}:
            path = np.array(run["path"])
            axis.plot(path[:, 1], path[:, 2], color="tab:red" if "then" in job.options else "0.3")
    axis.set(xlabel="x [m]", ylabel="y [m]", title="straight on (grey), with a change (red)")
    axis.set_aspect("equal", adjustable="datalim")


def table(results: Results) -> list[DataTable]:
    """Return one row a leg of each walk."""
    rows = []
    for job, run in results.items():
        ground = [
            f"{name} {job.options[name]:g}"
            for name in ("slope", "stairs", "strips")
            if name in job.options
        ]
        for leg in run["legs"]:
            if leg["measured_speed"] is not None:
                rows.append(
                    [
                        " ".join(ground) or "level",
                        f"{leg['speed']:g} toward {leg['heading']:g}",
                        f"{leg['measured_speed']:.3f} toward {leg['measured_heading']:.0f}",
                        str(run["steps"]),
                        run["reason"],
                    ]
                )
    return [DataTable("", ["ground", "ordered [m/s, deg]", "measured", "steps", ""], rows)]


FIGURES = (
    Figure(
        "V",
        "Walking or halting in any direction",
        "The inverted pendulum predicts where to move the feet to keep a stable walk, or to halt "
        "in any direction, on uneven terrain as well; the feet take their heading from the body.",
        jobs,
        draw,
        claims,
        table,
        (7.0, 6.0),
    ),
)
