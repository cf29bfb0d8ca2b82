"""Figures 4.3, 4.9 and 4.15: which targets walk, and the hip plots of the best walks."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from windup.tools.reproduce.laszlo.jobs import NAMES, SAMPLINGS, SEEDS, STEPS, cell, seeds, walked
from windup.tools.reproduce.laszlo.pictures import hip_plot, numbers, steps_text
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results

UP_GRID = (0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4)
FEW = (0.25, 0.4)
SWING_GRID = (-0.1, -0.05, 0.0, 0.05, 0.1)
COLORS = dict(zip(SAMPLINGS, ("tab:blue", "tab:orange", "tab:green"), strict=True))


@dataclass(frozen=True)
class Range:
    """Walks over a grid of forward targets, for each sampling, from several seeds."""

    rv: str
    servo: bool
    grid: tuple[float, ...]
    few: tuple[float, ...]

    def jobs(self, quick: bool) -> list[Job]:
        """Return all walks."""
        grid, count = (self.few, 1) if quick else (self.grid, SEEDS)
        return [job for s in SAMPLINGS for q in grid for job in self._cell(s, q)[:count]]

    def _cell(self, sampling: str, forward: float) -> list[Job]:
        return seeds(SEEDS, rv=[self.rv], sampling=sampling, forward=forward, servo=self.servo)

    def results(self, results: Results, sampling: str) -> dict[float, list[Result]]:
        """Return the results of one sampling by target."""
        found = {q: cell(self._cell(sampling, q), results) for q in self.grid}
        return {q: runs for q, runs in found.items() if runs}

    def band(self, results: Results, sampling: str) -> list[float]:
        """Return the targets at which every seed walks to the end."""
        cells = self.results(results, sampling)
        return [q for q, runs in cells.items() if all(walked(run) for run in runs)]

    def best(self, results: Results, sampling: str) -> tuple[float, Result]:
        """Return the most successful target, the middle one of several, and its first run."""
        cells = self.results(results, sampling)
        steps = {q: min(run["steps"] for run in runs) for q, runs in cells.items()}
        top = [q for q, count in steps.items() if count == max(steps.values())]
        middle = top[len(top) // 2]
        return middle, cells[middle][0]

    def mean_steps(self, results: Results, sampling: str) -> float:
        """Return the mean number of steps over the grid and the seeds."""
        cells = self.results(results, sampling)
        return float(np.mean([run["steps"] for runs in cells.values() for run in runs]))

    def draw(self, canvas: Any, results: Results) -> None:
        """Draw steps against the target, and the best walk from above, for each sampling."""
        axes = canvas.subplots(2, len(SAMPLINGS))
        for column, sampling in enumerate(SAMPLINGS):
            top, bottom = axes[:, column]
            cells = self.results(results, sampling)
            for q, runs in cells.items():
                top.plot([q] * len(runs), [r["steps"] for r in runs], "o", color="0.7", ms=4)
            low = [min(run["steps"] for run in runs) for runs in cells.values()]
            top.plot(list(cells), low, color=COLORS[sampling], marker=".", label="worst seed")
            top.set(title=NAMES[sampling], xlabel="forward target", ylim=(0, STEPS + 4))
            q, run = self.best(results, sampling)
            hip_plot(bottom, run, f"Q = {q:g}", COLORS[sampling])
            bottom.legend(fontsize="small")
        axes[0, 0].set(ylabel="steps")
        axes[0, 0].legend(fontsize="small")

    def table(self, results: Results) -> list[DataTable]:
        """Return the steps of every cell."""
        cells = {s: self.results(results, s) for s in SAMPLINGS}
        grid = [q for q in self.grid if any(q in row for row in cells.values())]
        rows = [[NAMES[s], *(steps_text(cells[s].get(q, [])) for q in grid)] for s in SAMPLINGS]
        return [
            DataTable(
                f"seeds that walked {STEPS} steps, and the steps, by forward target",
                ["sampling", *(f"{q:g}" for q in grid)],
                rows,
            )
        ]

    def band_claim(self, results: Results) -> Claim:
        """Judge that a band walks and that targets outside it fall."""
        bands = {s: self.band(results, s) for s in SAMPLINGS}
        tried = self.results(results, SAMPLINGS[0])
        ends = {min(tried), max(tried)}
        return Claim(
            "a band of targets walks 60 steps, with falls outside; much the same for all samplings",
            "all seeds walk at " + _bands(bands),
            "a common target for the three samplings, and none that walks at both ends",
            bool(set.intersection(*(set(band) for band in bands.values())))
            and not any(ends <= set(band) for band in bands.values()),
        )

    def mark(self, results: Results, wanted: dict[str, tuple[float, float]], text: str) -> Claim:
        """Judge a band that this human is known to walk (not a statement of the thesis)."""
        short = {}
        for sampling, (low, high) in wanted.items():
            cells = self.results(results, sampling)
            inside = {q for q in cells if low - 1e-9 <= q <= high + 1e-9}
            if missing := sorted(inside - set(self.band(results, sampling))):
                short[sampling] = missing
        fails = ", ".join(f"{NAMES[s]} falls at {numbers(qs)}" for s, qs in short.items())
        return Claim(text, fails or "all of these walk", "every seed", not short, own=True)


def _bands(bands: dict[str, list[float]]) -> str:
    return "; ".join(f"{NAMES[s]} {numbers(band)}" for s, band in bands.items())


UP = Range("up", False, UP_GRID, FEW)
SERVO = Range("up", True, UP_GRID, FEW)
SWING = Range("swing_com", False, SWING_GRID, (-0.05, 0.0, 0.05))


def claims_up(results: Results) -> list[Claim]:
    """Judge Fig. 4.3."""
    middle = dict.fromkeys(SAMPLINGS, (0.2, 0.3))
    return [UP.band_claim(results), UP.mark(results, middle, "no servo: .20 to .30, any sampling")]


def claims_swing(results: Results) -> list[Claim]:
    """Judge Fig. 4.9."""
    steps = {s: SWING.mean_steps(results, s) for s in SAMPLINGS}
    bands = {s: SWING.band(results, s) for s in SAMPLINGS}
    return [
        Claim(
            "a band of targets walks 60 steps",
            "all seeds walk at " + _bands(bands),
            "at least one target for some sampling",
            any(bands.values()),
        ),
        Claim(
            "SP walks best and F-L worst",
            "mean steps " + ", ".join(f"{NAMES[s]} {value:.1f}" for s, value in steps.items()),
            "in this order",
            steps["sp"] > steps["lf"] > steps["fl"],
        ),
    ]


def _turned(family: Range, results: Results) -> float:
    """Return the median change of heading of the walks that came to their end, degrees."""
    runs = [run for s in SAMPLINGS for cell in family.results(results, s).values() for run in cell]
    turned = [abs(run["records"][-1]["heading"]) for run in runs if walked(run)]
    return float(np.degrees(np.median(turned))) if turned else float("nan")


def claims_servo(results: Results) -> list[Claim]:
    """Judge Fig. 4.15 against 4.3."""
    common = set(SERVO.results(results, "fl")) & set(UP.results(results, "fl"))
    counts = {}
    for name, family in (("without", UP), ("with", SERVO)):
        counts[name] = sum(len(common & set(family.band(results, s))) for s in SAMPLINGS)
    straight, curved = _turned(SERVO, results), _turned(UP, results)
    return [
        Claim(
            "the servo widens the range of targets",
            f"{counts['with']} cells walk with it, {counts['without']} without",
            f"more cells, of {len(common)} targets and three samplings",
            counts["with"] > counts["without"],
        ),
        Claim(
            "paths become straighter",
            f"median turn over the walk {straight:.0f} degrees with it, {curved:.0f} without",
            "less",
            straight < curved,
        ),
        SERVO.mark(results, {"fl": (0.15, 0.3)}, "servo: F-L .15 to .30"),
    ]


FIGURES = (
    Figure(
        "4.3",
        "Up vector: range of targets and hip plots",
        "Steps (60 at most) against the forward target: a nominal range walks, similar for all "
        "three samplings; its middle gives the steadiest walks. Most paths curve.",
        UP.jobs,
        UP.draw,
        claims_up,
        UP.table,
        size=(13.0, 7.0),
    ),
    Figure(
        "4.9",
        "Swing-COM: range of targets and hip plots",
        "The same on swing-COM: again a range of targets that walks, but the samplings differ: SP "
        "is steadiest, F-L least so, and many walks twist sideways.",
        SWING.jobs,
        SWING.draw,
        claims_swing,
        SWING.table,
        size=(13.0, 7.0),
    ),
    Figure(
        "4.15",
        "Torso servo: range of targets and hip plots",
        "The trials of Fig. 4.3 with the torso servoed to 5 degrees: the useful range grows, and "
        "paths are straighter and more consistent.",
        lambda quick: SERVO.jobs(quick) + UP.jobs(quick),
        SERVO.draw,
        claims_servo,
        SERVO.table,
        size=(13.0, 7.0),
    ),
)
