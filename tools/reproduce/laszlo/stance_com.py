"""Table 4.1 and figure 4.14: stance-COM hits its target once, and falls."""

from typing import Any

import numpy as np

from windup.tools.reproduce.laszlo.jobs import walk
from windup.tools.reproduce.laszlo.recorder import records
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Results

# Target, then the thesis' K forward, K lateral, Q forward, Q lateral.
THESIS = {
    0.1: (-36.318, 5.544, 0.072, 0.007),
    0.15: (-10.918, 7.823, 0.154, 0.030),
    0.2: (14.481, 14.603, 0.208, -0.001),
    0.25: (39.881, -45.124, 0.254, -0.015),
    0.3: (65.280, -9.943, 0.335, -0.003),
}
SAMPLE = 5.0  # degrees
CLOSE = 0.035  # the thesis' own worst error


def _job(target: float) -> Job:
    return walk(rv=["stance_com"], forward=target, limits=False)


def jobs(quick: bool) -> list[Job]:
    """Return a walk for each target of the table."""
    return [_job(target) for target in THESIS]


def _first(results: Results, target: float) -> tuple[float, float, float, float] | None:
    """Return K and Q of the first step; None if it was never finished."""
    result = results[_job(target)]
    if not result["records"]:
        return None
    (k_fwd, k_lat), (q_fwd, q_lat) = records(result, "k")[0], records(result, "q")[0]
    return float(k_fwd), float(k_lat), float(q_fwd), float(q_lat)


def draw(canvas: Any, results: Results) -> None:
    """Draw the table: scaling against the value reached, and reached against wanted."""
    left, right = canvas.subplots(1, 2)
    ours = {target: _first(results, target) for target in THESIS}
    good = {target: row for target, row in ours.items() if row is not None}
    for axis, column, label in ((left, 0, "hip pitch scaling [degrees]"), (right, 2, "reached")):
        axis.plot(list(THESIS), [row[column] for row in THESIS.values()], "ks:", label="thesis")
        axis.plot(list(good), [row[column] for row in good.values()], "o-", label="ours")
        axis.set(xlabel="wanted forward stance-COM", ylabel=label)
    right.plot([0.1, 0.3], [0.1, 0.3], color="0.8", zorder=0)
    left.legend()


def claims(results: Results) -> list[Claim]:
    """Judge the first step and what comes after."""
    ours = {target: _first(results, target) for target in THESIS}
    errors = {t: abs(row[2] - t) if row else float("nan") for t, row in ours.items()}
    steps = [results[_job(target)]["steps"] for target in THESIS]
    close = {t: abs(row[0]) for t, row in ours.items() if row and errors[t] <= CLOSE}
    reach = max(close.values(), default=0.0) / SAMPLE
    return [
        Claim(
            "the walks fall at once, most during the second step",
            f"steps finished: {', '.join(map(str, steps))}",
            "median of 2 or fewer",
            float(np.median(steps)) <= 2,
        ),
        Claim(
            "the first step reaches its target closely",
            "errors " + ", ".join(f"{t:g}: {value:.3f}" for t, value in errors.items()),
            f"all within the thesis' worst, {CLOSE:g}",
            all(value <= CLOSE for value in errors.values()),
        ),
        Claim(
            "even for scalings up to 13 times those sampled",
            f"up to {reach:.1f} times, among targets reached within {CLOSE:g}",
            "5 times or more",
            reach >= 5.0,
        ),
    ]


def table(results: Results) -> list[DataTable]:
    """Return Table 4.1 with ours beside it."""
    rows = []
    for target, thesis in THESIS.items():
        ours = _first(results, target)
        cells = ["-"] * 4 if ours is None else [f"{value:+.3f}" for value in ours]
        rows.append(
            [f"{target:g}", *(f"{t:+.3f} | {c}" for t, c in zip(thesis, cells, strict=True))]
        )
    header = ["wanted", "K forward", "K lateral", "Q forward", "Q lateral"]
    return [DataTable("first controlled step: thesis | ours (K in degrees)", header, rows)]


FIGURES = (
    Figure(
        "4.14",
        "Stance-COM: one good step (and table 4.1)",
        "Small changes of stance-COM need very large hip scalings, which throw the body far off: "
        "the walks fall. But the first step reaches its target, with scalings up to 13 times "
        "those of the samples: the model holds over a wide range.",
        jobs,
        draw,
        claims,
        table,
    ),
)
