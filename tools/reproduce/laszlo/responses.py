"""Figures 3.16 and 3.17: regulation variables against the scaling of a perturbation."""

from functools import partial
from typing import Any

import numpy as np

from windup.hal.joints import Array
from windup.tools.reproduce.laszlo.work import VECTORS
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results

STEPS = (1, 2, 3, 4)  # by the fourth the figure is falling noticeably
RANGES = ((-20.0, 20.0), (-10.0, 10.0))  # degrees of pitch and roll
NAMES = ("hip pitch", "hip roll")
AXES = ("forward", "lateral")


def jobs(vary: int, quick: bool) -> list[Job]:
    """Return one sampled step for each of the first steps."""
    scalings = np.linspace(*RANGES[vary], 11).tolist()
    return [
        Job("response", {"vary": vary, "step": step, "scalings": scalings, "seed": 0})
        for step in STEPS
    ]


def _curve(job: Job, result: Result, name: str) -> tuple[Array, Array]:
    """Return scalings and values of one variable, without samples that fell."""
    if name not in result["names"] or not result["q"]:
        return np.zeros(0), np.zeros(0)
    stood = ~np.array(result["fell"], dtype=bool)
    values = np.array(result["q"])[:, result["names"].index(name)]
    return np.array(job.options["scalings"])[stood], values[stood]


def fit(k: Array, q: Array) -> tuple[float, float]:
    """Return slope and R2 of a straight line."""
    if len(k) < 3:
        return float("nan"), float("nan")
    from scipy.stats import linregress  # slow to import, and only the judgement needs it

    line = linregress(k, q)
    return float(line.slope), float(line.rvalue**2)


def _fits(results: Results, name: str) -> list[tuple[float, float]]:
    return [fit(*_curve(job, result, name)) for job, result in results.items()]


def draw(vary: int, canvas: Any, results: Results) -> None:
    """Draw the thesis' six panels."""
    axes = canvas.subplots(len(VECTORS), 2, sharex=True)
    for row, vector in enumerate(VECTORS):
        for side, axis in enumerate(AXES):
            for job, result in results.items():
                k, q = _curve(job, result, f"{vector}.{axis}")
                axes[row, side].plot(k, q, marker=".", label=f"step {job.options['step']}")
            axes[row, side].set(ylabel=f"{vector} {axis}")
    axes[0, 0].legend(fontsize="small")
    for axis in axes[-1]:
        axis.set(xlabel=f"{NAMES[vary]} scaling [degrees]")


def claims(vary: int, results: Results) -> list[Claim]:
    """Judge linearity, the sign of the stance-COM slope, and the coupling."""
    main, other = AXES[vary], AXES[1 - vary]
    out = [_linear(results, vector, main) for vector in VECTORS]
    slopes = {
        v: float(np.nanmedian([s for s, _ in _fits(results, f"{v}.{main}")])) for v in VECTORS
    }
    signs = {v: np.sign(slope) for v, slope in slopes.items()}
    out.append(
        Claim(
            "the stance-COM curve slopes the other way than up vector and swing-COM",
            ", ".join(f"{v} {slope:+.4f} a degree" for v, slope in slopes.items()),
            "its sign differs from both",
            bool(signs["up"] == signs["swing_com"] == -signs["stance_com"]),
        )
    )
    cross = {
        v: float(np.nanmedian([s for s, _ in _fits(results, f"{v}.{other}")])) for v in VECTORS
    }
    ratio = {v: abs(cross[v] / slopes[v]) for v in ("up", "swing_com")}
    out.append(
        Claim(
            f"the {other} components move little, next to the {main} ones",
            ", ".join(f"{v} {value:.0%}" for v, value in ratio.items()),
            "median slope below 50 % of the other",
            all(value < 0.5 for value in ratio.values()),
        )
    )
    return out


def _linear(results: Results, vector: str, axis: str) -> Claim:
    worst = [fitted for _, fitted in _fits(results, f"{vector}.{axis}")][:3]
    text = ", ".join(f"step {i + 1}: {value:.3f}" for i, value in enumerate(worst))
    return Claim(
        f"{vector} {axis} is nearly linear in the scaling",
        f"R2 of a straight line {text}",
        "0.95 or more in each of the first three steps",
        all(value >= 0.95 for value in worst),
    )


def table(vary: int, results: Results) -> list[DataTable]:
    """Return the slopes."""
    rows = []
    for vector in VECTORS:
        for axis in AXES:
            fits = _fits(results, f"{vector}.{axis}")
            rows.append([f"{vector} {axis}", *(f"{s:+.4f} (R2 {r:.3f})" for s, r in fits)])
    header = ["variable", *(f"step {step}" for step in STEPS)]
    return [DataTable("slope a degree of scaling", header, rows)]


def _figure(name: str, vary: int) -> Figure:
    return Figure(
        name,
        f"Regulation variables against {NAMES[vary]}",
        f"At the end of each of the first steps of the open loop, the {AXES[vary]} component of "
        f"all three vectors is nearly linear in the scaling of the stance {NAMES[vary]} "
        "perturbation; the slope of stance-COM has the other sign, and the other component moves "
        "too, but less.",
        partial(jobs, vary),
        partial(draw, vary),
        partial(claims, vary),
        partial(table, vary),
        size=(10.0, 9.0),
    )


FIGURES = (_figure("3.16", 0), _figure("3.17", 1))
