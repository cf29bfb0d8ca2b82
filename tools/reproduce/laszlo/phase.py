"""Figures 4.2, 4.8 and 4.16: the motion between samples, and whether it is a limit cycle."""

from functools import partial
from typing import Any

import numpy as np

from windup.hal.joints import Array
from windup.tools.reproduce.laszlo.jobs import NAMES, walk
from windup.tools.reproduce.laszlo.recorder import column
from windup.tools.reproduce.study.figure import Claim, Figure, Job, Result, Results

UP = (
    walk(sampling="fl", forward=0.25),
    walk(sampling="lf", forward=0.2),
    walk(sampling="sp", forward=0.3),
    walk(sampling="lf", forward=0.35),  # the thesis' chaotic walk
)
SWING = (
    walk(rv=["swing_com"], sampling="fl", forward=-0.05),
    walk(rv=["swing_com"], sampling="lf", forward=0.0),
    walk(rv=["swing_com"], sampling="sp", forward=0.0),
)
SERVO = (walk(sampling="fl", forward=0.25, servo=True), walk(sampling="fl", forward=0.25))
UP_NAMES = ("up.f", "up.l")
COM_NAMES = (("left_com.f", "left_com.l"), ("right_com.f", "right_com.l"))
CYCLES = 10  # the last ones; a cycle is two steps
PHASES = 50
CLEAR = 0.15


def cycles(result: Result, names: tuple[str, str]) -> Array:
    """Return the last cycles (c, PHASES, 2) of two columns of a trace, over the phase."""
    step = column(result, "step").astype(int)
    xy = np.stack([column(result, name) for name in names], axis=-1)
    whole = result["steps"] // 2
    found = []
    for number in range(max(whole - CYCLES, 2), whole):  # the first two are the start
        rows = xy[(step == 2 * number) | (step == 2 * number + 1)]
        if len(rows) > 5:
            phase = np.linspace(0.0, 1.0, len(rows))
            at = np.linspace(0.0, 1.0, PHASES)
            found.append(np.stack([np.interp(at, phase, rows[:, i]) for i in (0, 1)], axis=-1))
    return np.array(found).reshape(-1, PHASES, 2)


def scatter(result: Result, names: tuple[str, str] = ("up.f", "up.l")) -> float:
    """Return how far cycles lie apart, over the size of a cycle: 0 is a limit cycle.

    NaN where there are fewer than three cycles past the start.
    """
    orbit = cycles(result, names)
    if len(orbit) < 3:
        return float("nan")
    apart = np.sqrt(np.mean(orbit.var(axis=0)))
    size = np.sqrt(np.mean(orbit.mean(axis=0).var(axis=0)))
    return float(apart / max(size, 1e-9))


def pitch_range(result: Result) -> float:
    """Return the range of the torso's pitch over a cycle, degrees (median of the last ones)."""
    orbit = cycles(result, ("up.f", "up.l"))
    if not len(orbit):
        return float("nan")
    return float(np.degrees(np.median(np.ptp(np.arcsin(orbit[:, :, 0]), axis=1))))


def _title(job: Job) -> str:
    servo = ", torso servo" if job.options["servo"] else ""
    return f"{NAMES[job.options['sampling']]}, Q = {job.options['forward']:g}{servo}"


def _scatter(value: float) -> str:
    return "falls too soon to tell" if np.isnan(value) else f"scatter {value:.2f}"


def draw(planes: tuple[tuple[str, str], ...], canvas: Any, results: Results) -> None:
    """Draw the last cycles of each walk on the plane of two components."""
    axes = np.ravel(canvas.subplots(1, len(results)))
    for axis, (job, result) in zip(axes, results.items(), strict=True):
        for plane in planes:
            for orbit in cycles(result, plane):
                color = "tab:blue" if plane is planes[0] else "tab:orange"
                axis.plot(orbit[:, 0], orbit[:, 1], color=color, linewidth=0.6)
        axis.set(title=f"{_title(job)}: {result['steps']} steps", xlabel="forward")
    axes[0].set(ylabel="to the left")


def claims_up(results: Results) -> list[Claim]:
    """Judge the first three walks as cycles and the fourth as none."""
    spread = {_title(job): scatter(results[job]) for job in UP}
    clear = [name for name, value in spread.items() if value < CLEAR]
    loose = scatter(results[UP[3]])
    steady = [scatter(results[job]) for job in UP[:3]]
    return [
        Claim(
            "a clear limit cycle in three of four walks of 60 steps",
            ", ".join(f"{name}: {_scatter(value)}" for name, value in spread.items()),
            f"scatter of the last {CYCLES} cycles below {CLEAR:g} of their size in three",
            len(clear) >= 3,
        ),
        Claim(
            "the fourth, at the upper end of the range, is chaotic",
            f"{results[UP[3]]['steps']} steps, {_scatter(loose)}",
            "walks, with a scatter above the other three's",
            bool(not results[UP[3]]["fell"] and loose > np.nanmax(steady)),
        ),
    ]


def claims_swing(results: Results) -> list[Claim]:
    """Judge the swing-COM walks against the up vector's."""
    spread = {_title(job): scatter(results[job], COM_NAMES[0]) for job in SWING}
    steps = {_title(job): results[job]["steps"] for job in SWING}
    return [
        Claim(
            "swing-COM walks drift about in near-cycles, or converge slowly",
            ", ".join(f"{name}: {_scatter(value)}" for name, value in spread.items()),
            f"one or more to judge, and none with a scatter below {CLEAR:g}",
            bool(np.nanmin([np.inf, *spread.values()]) >= CLEAR)
            and not all(np.isnan(value) for value in spread.values()),
        ),
        Claim(
            "all three walk",
            ", ".join(f"{name}: {value} steps" for name, value in steps.items()),
            "60 steps each",
            not any(results[job]["fell"] for job in SWING),
        ),
    ]


def claims_servo(results: Results) -> list[Claim]:
    """Judge what the torso servo does to the torso's pitch."""
    with_servo, without = (pitch_range(results[job]) for job in SERVO)
    return [
        Claim(
            "without the servo the torso's pitch ranges over about 12 degrees",
            f"{without:.1f} degrees",
            "8 to 16",
            8.0 <= without <= 16.0,
        ),
        Claim(
            "the torso servo brings it down to about 3 degrees",
            f"{with_servo:.1f} degrees",
            "5 or less, and less than half",
            bool(with_servo <= 5.0 and with_servo < 0.5 * without),
        ),
    ]


FIGURES = (
    Figure(
        "4.2",
        "Up vector: phase diagrams",
        "The up vector's two components through whole walks: three walks lie on a clear limit "
        "cycle, the fourth (L-F, Q = .35) is chaotic and yet does not fall.",
        lambda quick: list(UP),
        partial(draw, (UP_NAMES,)),
        claims_up,
        size=(14.0, 4.0),
    ),
    Figure(
        "4.8",
        "Swing-COM: phase diagrams",
        "The vectors from both feet to the centre of mass, in walks on swing-COM: near-cycles "
        "that drift or converge slowly, no strong limit cycle as with the up vector.",
        lambda quick: list(SWING),
        partial(draw, COM_NAMES),
        claims_swing,
        size=(12.0, 4.0),
    ),
    Figure(
        "4.16",
        "Torso servo: phase diagram",
        "With the torso servo at 5 degrees the torso bobs far less: about 3 degrees instead of 12.",
        lambda quick: list(SERVO),
        partial(draw, (UP_NAMES,)),
        claims_servo,
        size=(9.0, 4.0),
    ),
)
