"""Figure 6: two pushes, steps, and back to a relaxed stance."""

from typing import Any

import numpy as np

from windup.hal.geometry.angles import wrapped
from windup.tools.reproduce.kenwright.jobs import cell, count, push
from windup.tools.reproduce.kenwright.recorder import apart, column
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results

IMPULSE = 1.8  # N s
EVERY = 8.0  # s; time to come to rest between the two
PAIRS = ((0.0, 180.0), (180.0, 0.0), (30.0, -150.0), (90.0, -90.0), (150.0, -30.0), (-45.0, 20.0))
SEEDS = 3
RELAXED, FACING = 0.02, 8.0  # m and degrees from the stance


def _job(pair: tuple[float, float], seed: int) -> Job:
    return push(IMPULSE, pair, seed, every=EVERY)


def jobs(quick: bool) -> list[Job]:
    """Return two pushes one after the other."""
    pairs, seeds = (PAIRS[:2], 1) if quick else (PAIRS, SEEDS)
    return [_job(pair, seed) for pair in pairs for seed in range(seeds)]


def facing(result: Result) -> float:
    """Return how far the foot that is turned more is from the trunk's heading at the end, deg."""
    yaw = column(result, "yaw")[-1]
    away = np.array([column(result, f"{foot}.yaw")[-1] - yaw for foot in ("left", "right")])
    return float(np.degrees(np.abs(wrapped(away))).max())


def relaxed(result: Result) -> bool:
    """Return whether a robot that survived has its feet where the stance has them."""
    return bool(result["survived"]) and result["astray_m"] <= RELAXED and facing(result) <= FACING


def claims(results: Results) -> list[Claim]:
    """Judge that it stands, steps, and relaxes."""
    runs = cell(jobs(False), results)
    stood = [run for run in runs if run["survived"]]
    steps = [run["steps"] for run in runs]
    eased = sum(relaxed(run) for run in runs)
    away = max((1e3 * run["astray_m"] for run in stood), default=np.nan)
    turned = max((facing(run) for run in stood), default=np.nan)
    return [
        Claim(
            "it is pushed twice and stays up",
            f"{count(runs)} runs of two pushes of {IMPULSE:g} N s stay up",
            "all",
            len(stood) == len(runs),
        ),
        Claim(
            "it is forced to take corrective steps",
            f"{sum(step > 0 for step in steps)} of {len(runs)} runs step, {sum(steps)} steps",
            "every run steps",
            all(step > 0 for step in steps),
        ),
        Claim(
            "it returns to a relaxed stance",
            f"{eased} of {len(runs)} do; at the end the feet of those that stand are at most "
            f"{away:.0f} mm and {turned:.0f} degrees from it",
            f"all within {1e3 * RELAXED:.0f} mm and {FACING:g} degrees",
            eased == len(runs),
        ),
    ]


def draw(canvas: Any, results: Results) -> None:
    """Draw the weight and the feet of the first run over time, and the steps in grey."""
    result = next(iter(results.values()))
    time, phase = column(result, "time"), column(result, "phase")
    gap = apart(result)
    for axis, name, part in zip(canvas.subplots(2, 1, sharex=True), "xy", (0, 1), strict=True):
        axis.plot(time, 1e3 * column(result, f"cp.{name}"), color="0.6", label="capture point")
        axis.plot(time, 1e3 * column(result, f"com.{name}"), "k", label="centre of mass")
        axis.plot(time, 1e3 * gap[:, part], label="left foot from the right one")
        for number, tint in ((1, "tab:red"), (3, "tab:green")):
            axis.fill_between(
                *(time, 0, 1), where=phase == number, color=tint, alpha=0.2, linewidth=0,
                transform=axis.get_xaxis_transform(),
                label="steps" if number == 1 else "comfort steps",
            )  # fmt: skip
        axis.set(ylabel=f"{name} [mm]")
    axis.set(xlabel="time [s]")
    axis.legend(fontsize="small", loc="upper right")


def table(results: Results) -> list[DataTable]:
    """Return one row a run."""
    rows = [
        [
            ", ".join(f"{direction:g}" for direction in run["directions"]),
            str(run["seed"]),
            "stands" if run["survived"] else "fell",
            f"{run['steps']} and {run['comfort_steps']}",
            f"{1e3 * run['astray_m']:.0f}" if run["survived"] else "",
            f"{facing(run):.0f}" if run["survived"] else "",
        ]
        for run in results.values()
    ]
    header = ["pushes [deg]", "seed", "", "steps, comfort steps", "feet off [mm]", "turned [deg]"]
    return [DataTable("", header, rows)]


FIGURES = (
    Figure(
        "6",
        "Pushed twice, and back to a relaxed stance",
        "The model stands, is pushed twice, is forced to take corrective steps, and returns to a "
        "relaxed stance.",
        jobs,
        draw,
        claims,
        table,
        (10.0, 6.0),
    ),
)
