"""Figure 4 and section 6: reactive steps; when to stand, and several impulses in a row."""

from typing import Any

import numpy as np

from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Results
from windup.tools.reproduce.wu_zordan.jobs import AROUND, EIGHT, FOUR, cell, count, push, where

FORCE = 170.0  # N, of the paper
FORCES = (50.0, 100.0, FORCE, 250.0, 400.0, 500.0)
SEVERAL, SERIES = 4, 8
WAYS = ("feet", "momentum")


def _push(force: float, way: str, quick: bool) -> list[Job]:
    around = FOUR if quick else AROUND if force == FORCE else EIGHT
    return [push(force, [direction], way) for direction in around]


def _series(quick: bool) -> list[Job]:
    draws = [np.random.default_rng([4, k]).uniform(-180.0, 180.0, SEVERAL) for k in range(SERIES)]
    return [
        push(FORCE, directions.round(1).tolist()) for directions in draws[: 2 if quick else None]
    ]


def jobs(quick: bool) -> list[Job]:
    """Return pushes that are met by steps or by standing alone, and series of them."""
    forces = (FORCES[0], FORCE, FORCES[-1]) if quick else FORCES
    met = [job for force in forces for way in WAYS for job in _push(force, way, quick)]
    return [*dict.fromkeys([*met, *_series(quick)])]


def claims(results: Results) -> list[Claim]:
    """Judge steps, standing, and series."""
    return [*_stepping(results), *_standing(results), *_beyond(results)]


def _stepping(results: Results) -> list[Claim]:
    """Judge the steps that answer one impact, and several."""
    runs = cell(_push(FORCE, "momentum", False), results)
    series = cell(_series(False), results)
    stepped = [run for run in runs if run["steps"] > 0]
    ahead = [np.cos(np.radians(run["directions"][0])) for run in stepped]
    both = max(ahead, default=0.0) > 0.5 and min(ahead, default=0.0) < -0.5
    return [
        Claim(
            f"an impact of {FORCE:g} N for 0.1 s is sustained by steps in various directions",
            f"{count(runs)} directions stay up, with steps toward {where(stepped)}",
            "all stay up, and some step forward, some backward",
            all(run["survived"] for run in runs) and both,
        ),
        Claim(
            f"multiple impulses of {FORCE:g} N are sustained",
            f"{count(series)} series of {SEVERAL}, 1 s apart, each in a random direction, with "
            f"{sum(run['steps'] for run in series)} steps in all",
            "all stay up",
            all(run["survived"] for run in series),
        ),
    ]


def _standing(results: Results) -> list[Claim]:
    """Judge when no step is taken, and what standing bears without any."""
    stood = [
        run
        for force in FORCES
        for run in cell(_push(force, "momentum", False), results)
        if run["survived"] and run["steps"] == 0
    ]
    least = [run["force"] for run in stood]
    alone = cell(_push(FORCE, "feet", False), results)
    return [
        Claim(
            "the supervisor can opt not to step and use standing balance",
            f"{len(stood)} pushes of up to {max(least, default=0.0):g} N are stood without a step",
            "some, and all below 60 N",
            bool(stood)
            and all(r["steps"] == 0 for r in cell(_push(FORCES[0], "momentum", False), results)),
        ),
        Claim(
            f"standing alone bears {FORCE:g} N",
            f"{count(alone)} directions",
            "all",
            all(run["survived"] for run in alone),
            own=True,
        ),
    ]


def _beyond(results: Results) -> list[Claim]:
    """Return what steps are worth where standing does not suffice."""
    above = [force for force in FORCES if force > FORCE]
    runs = {way: [r for f in above for r in cell(_push(f, way, False), results)] for way in WAYS}
    total = len(runs["feet"])
    alone, met = (sum(run["survived"] for run in runs[way]) for way in WAYS)
    fell = [r for r in cell(_push(FORCES[-1], "momentum", False), results) if not r["survived"]]
    return [
        Claim(
            f"above {FORCE:g} N it takes steps",
            f"of {total} pushes of up to {FORCES[-1]:g} N standing survives {alone}, steps {met}; "
            f"at {FORCES[-1]:g} N these fall toward {where(fell)}",
            "steps survive all, standing half or less",
            met == total and alone <= 0.5 * total if total else None,
            own=True,
        )
    ]


def draw(canvas: Any, results: Results) -> None:
    """Draw what part of the directions survives at each force, and how many steps it takes."""
    left, right = canvas.subplots(1, 2)
    for way in WAYS:
        at, part, steps = [], [], []
        for force in FORCES:
            runs = cell(_push(force, way, False), results)
            if runs:
                at.append(force)
                part.append(100.0 * np.mean([run["survived"] for run in runs]))
                steps.append(np.mean([run["steps"] for run in runs]))
        left.plot(at, part, "o-", label={"feet": "standing alone"}.get(way, "momentum supervisor"))
        right.plot(at, steps, "o-")
    left.axvline(FORCE, color="k", linewidth=0.8, linestyle=":")
    left.set(xlabel="force for 0.1 s [N]", ylabel="directions survived [%]", ylim=(-5, 105))
    right.set(xlabel="force for 0.1 s [N]", ylabel="steps in the mean")
    left.legend()


def table(results: Results) -> list[DataTable]:
    """Return how many directions survive each force."""
    rows = []
    for way in WAYS:
        for force in FORCES:
            if runs := cell(_push(force, way, False), results):
                steps = sorted(run["steps"] for run in runs)
                rows.append([way, f"{force:g}", count(runs), f"{steps[0]}-{steps[-1]}"])
    return [DataTable("", ["way", "force [N]", "survived", "steps"], rows)]


FIGURES = (
    Figure(
        "4",
        "Reactive steps",
        "Impacts of 170 N for 0.1 s, several in a row, are answered by steps in various "
        "directions, as many as it takes; where none is needed the supervisor stands.",
        jobs,
        draw,
        claims,
        table,
    ),
)
