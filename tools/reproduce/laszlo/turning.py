"""Figures 5.7 to 5.9: turning by a constant scaling of the turning perturbation."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from windup.tools.reproduce.laszlo.jobs import NAMES, SAMPLINGS, cell, walk, walked
from windup.tools.reproduce.laszlo.pictures import hip_plot
from windup.tools.reproduce.laszlo.recorder import records
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results

DEGREES = (2.0, 4.0, 6.0, 8.0)
FEW = (2.0, 8.0)
RADIUS = 2.5  # m, the thesis' smallest without servo


def radius(result: Result) -> float:
    """Return the way over the change of heading, m, after the start."""
    way = records(result, "speed") * records(result, "duration")
    turned = records(result, "heading")
    if len(way) < 20:
        return float("nan")
    return float(way[10:].sum() / max(abs(turned[-1] - turned[9]), 1e-6))


def rate(result: Result) -> float:
    """Return the turn of a step, degrees."""
    turned = np.degrees(records(result, "heading"))
    return float((turned[-1] - turned[9]) / (len(turned) - 10)) if len(turned) > 20 else np.nan


@dataclass(frozen=True)
class Turns:
    """Walks at several scalings of the turn, for some samplings."""

    forward: float
    servo: bool
    samplings: tuple[str, ...]

    def _job(self, sampling: str, degrees: float) -> Job:
        return walk(sampling=sampling, forward=self.forward, servo=self.servo, turn=degrees)

    def jobs(self, quick: bool) -> list[Job]:
        """Return all walks."""
        if quick:
            return [self._job(self.samplings[0], degrees) for degrees in FEW]
        return [self._job(s, degrees) for s in self.samplings for degrees in DEGREES]

    def rows(self, results: Results, sampling: str) -> dict[float, Result]:
        """Return the results of one sampling by scaling."""
        found = {d: cell([self._job(sampling, d)], results) for d in DEGREES}
        return {d: runs[0] for d, runs in found.items() if runs}

    def draw(self, canvas: Any, results: Results) -> None:
        """Draw the paths, a panel for each sampling."""
        shown = [s for s in self.samplings if self.rows(results, s)]
        for axis, sampling in zip(np.ravel(canvas.subplots(1, len(shown))), shown, strict=True):
            for i, (degrees, run) in enumerate(self.rows(results, sampling).items()):
                hip_plot(axis, run, f"{degrees:g}", f"C{i}")
            axis.set_title(f"{NAMES[sampling]}, Q = {self.forward:g}")
            axis.legend(fontsize="small", title="degrees")

    def table(self, results: Results) -> list[DataTable]:
        """Return radius and rate of each walk."""
        rows = [
            [
                NAMES[sampling],
                f"{degrees:g}",
                str(run["steps"]),
                f"{radius(run):.1f}",
                f"{rate(run):.2f}",
            ]
            for sampling in self.samplings
            for degrees, run in self.rows(results, sampling).items()
        ]
        return [
            DataTable("", ["sampling", "scaling", "steps", "radius [m]", "degrees a step"], rows)
        ]

    def all(self, results: Results) -> list[Result]:
        """Return the results of all walks."""
        return [run for s in self.samplings for run in self.rows(results, s).values()]

    def fit(self, results: Results) -> float:
        """Return the worst correlation of turn and scaling over the samplings."""
        fits = []
        for sampling in self.samplings:
            rows = self.rows(results, sampling)
            if len(rows) > 2:
                turned = [rate(run) for run in rows.values()]
                if np.ptp(turned) > 0.0:
                    fits.append(float(np.corrcoef(list(rows), turned)[0, 1]))
        return float(np.min(fits)) if fits else float("nan")


GOOD = Turns(0.25, False, SAMPLINGS)
POOR = Turns(0.3, False, SAMPLINGS)
SERVO = Turns(0.25, True, ("fl",))


def claims_good(results: Results) -> list[Claim]:
    """Judge Fig. 5.7."""
    return [_all_walk(GOOD, results), _tightest(GOOD, results, RADIUS), _monotone(GOOD, results)]


def claims_poor(results: Results) -> list[Claim]:
    """Judge Fig. 5.8 against 5.7."""
    poor, good = POOR.fit(results), GOOD.fit(results)
    fell = sum(not walked(run) for run in POOR.all(results))
    return [
        Claim(
            "away from the middle of the range, turning is less regular",
            f"correlation of turn and scaling {poor:.2f}, {good:.2f} in the middle; {fell} fell",
            "lower, or some fall",
            bool(poor < good or fell) if np.isfinite([poor, good]).all() or fell else None,
        )
    ]


def claims_servo(results: Results) -> list[Claim]:
    """Judge Fig. 5.9 against 5.7."""
    tight = min((radius(r) for r in SERVO.all(results) if walked(r)), default=float("nan"))
    rows = GOOD.rows(results, "fl").values()
    other = min((radius(r) for r in rows if walked(r)), default=float("nan"))
    return [
        _all_walk(SERVO, results),
        Claim(
            "with the torso servo circles are tighter",
            f"{tight:.1f} m, without it {other:.1f} m",
            "smaller by a tenth or more",
            tight < 0.9 * other,
        ),
    ]


def _all_walk(turns: Turns, results: Results) -> Claim:
    runs = turns.all(results)
    count = sum(walked(run) for run in runs)
    ours = f"{count} of {len(runs)} walk 60 steps"
    return Claim("turning works for each sampling", ours, "all", count == len(runs))


def _tightest(turns: Turns, results: Results, wanted: float) -> Claim:
    tight = min((radius(r) for r in turns.all(results) if walked(r)), default=float("nan"))
    return Claim(
        f"8 degrees turn with a radius of about {wanted:g} m",
        f"{tight:.1f} m at the tightest",
        f"{1.5 * wanted:g} m or less",
        tight <= 1.5 * wanted,
    )


def _monotone(turns: Turns, results: Results) -> Claim:
    spans = []
    grows = True
    for sampling in turns.samplings:
        turned = [rate(run) for run in turns.rows(results, sampling).values()]
        if turned:
            spans.append(f"{NAMES[sampling]} " + ", ".join(f"{value:.1f}" for value in turned))
            grows &= bool(np.all(np.diff(turned) > 0.0))
    return Claim(
        "a larger scaling turns more",
        "degrees a step: " + "; ".join(spans),
        "each more than the one before",
        grows,
    )


FIGURES = (
    Figure(
        "5.7",
        "Turning, middle of the range",
        "Constant scalings of the turning perturbation walk circles with each sampling; the "
        "largest, 8 degrees of hip yaw a leg, turns with a radius of about 2.5 m.",
        GOOD.jobs,
        GOOD.draw,
        claims_good,
        GOOD.table,
        size=(13.0, 4.5),
    ),
    Figure(
        "5.8",
        "Turning, other targets",
        "Not every target turns as well: the same scalings give smooth walks, but not the circles "
        "of Fig. 5.7.",
        lambda quick: POOR.jobs(quick) + GOOD.jobs(quick),
        POOR.draw,
        claims_poor,
        POOR.table,
        size=(13.0, 4.5),
    ),
    Figure(
        "5.9",
        "Turning with the torso servo",
        "The torso servo helps: the walk is slower and the circles are tighter.",
        lambda quick: SERVO.jobs(quick) + GOOD.jobs(quick),
        SERVO.draw,
        claims_servo,
        SERVO.table,
        size=(7.0, 5.0),
    ),
)
