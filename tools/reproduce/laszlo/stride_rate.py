"""Figures 5.13 and 5.14: longer and shorter steps by the stride rate perturbation of Fig. 5.12."""

from typing import Any

import numpy as np

from windup.tools.reproduce.laszlo.jobs import cell, walked
from windup.tools.reproduce.laszlo.recorder import records
from windup.tools.reproduce.laszlo.tours import tour
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results

HOLDS = (-0.05, 0.0, 0.05, 0.1)  # s more in each timed state
FEW = (-0.05, 0.05)
SETTLED = 30  # steps: the style takes 25 to come in
VARIED = tour(style=["stride_time=0.05@6:20"], speed=0.85, steps=80)  # with speed control


def _held(hold: float) -> Job:
    return tour(style=[f"stride_time={hold:g}"], steps=60)


def jobs(quick: bool) -> list[Job]:
    """Return walks at constant stride rates."""
    return [_held(hold) for hold in (FEW if quick else HOLDS)]


def rates(result: Result) -> Any:
    """Return strides a second of each step (steps,); a stride is two steps."""
    return 0.5 / records(result, "duration")


def draw_rates(canvas: Any, results: Results) -> None:
    """Draw stride rates over the steps, and step length against the duration of a step."""
    over, against = canvas.subplots(1, 2)
    for i, hold in enumerate(HOLDS):
        for run in cell([_held(hold)], results):
            over.plot(rates(run), color=f"C{i}", label=f"{hold:+g} s")
            step, length = records(run, "duration"), records(run, "length")
            against.plot(step[SETTLED:], length[SETTLED:], ".", color=f"C{i}")
    over.set(xlabel="step", ylabel="strides a second")
    over.legend(fontsize="small", title="hold time")
    against.set(xlabel="duration of a step [s]", ylabel="step length [m]")


def claims_rates(results: Results) -> list[Claim]:
    """Judge the span of stride rates, and that length goes with the hold time."""
    runs = {h: run for h in HOLDS for run in cell([_held(h)], results)}
    good = {h: run for h, run in runs.items() if walked(run)}
    mean = {h: float(rates(run)[SETTLED:].mean()) for h, run in good.items()}
    span = f"{min(mean.values()):.2f} to {max(mean.values()):.2f}" if mean else "none walks"
    return [
        Claim(
            "stride rates from 0.8 to about 1.25 strides a second",
            f"{span} strides a second; {len(good)} of {len(runs)} walk 60 steps",
            "fastest over slowest 1.25 / 0.8 or more, at no more than those rates' edges",
            bool(mean) and max(mean.values()) / min(mean.values()) >= 1.25 / 0.8
            if len(runs) > 2
            else None,
        ),
        Claim(
            "at a constant speed the stride length rises with the hold time",
            ", ".join(f"{h:+g} s: {_length(run):.2f} m" for h, run in good.items()) or "none walks",
            "each longer than the one before",
            bool(np.all(np.diff([_length(run) for run in good.values()]) > 0.0))
            if len(good) > 1
            else None,
        ),
    ]


def _length(result: Result) -> float:
    return float(np.nanmean(records(result, "length")[SETTLED:]))


def draw_speed(canvas: Any, results: Results) -> None:
    """Draw speed and stride rate of one walk in which the rate goes down and up again."""
    axis, run = canvas.subplots(), results[VARIED]
    axis.plot(records(run, "time"), records(run, "speed"), label="speed [m/s]")
    axis.plot(records(run, "time"), rates(run), label="strides a second")
    axis.set(xlabel="time [s]", ylim=(0.0, None))
    axis.legend(fontsize="small")


def claims_speed(results: Results) -> list[Claim]:
    """Judge that the speed stays while the stride rate changes within one walk."""
    run = results[VARIED]
    if not walked(run):
        fell = f"fell after {run['steps']} steps"
        return [Claim("the stride rate changes within a walk", fell, "walked", False)]
    rate, pace = rates(run)[10:], records(run, "speed")[10:]
    swing = float(np.ptp(pace) / pace.mean())
    return [
        Claim(
            "the speed stays relatively constant while the stride rate changes within a walk",
            f"rate {rate.min():.2f} to {rate.max():.2f} strides a second, speed varies by "
            f"{swing:.0%} of its mean {pace.mean():.2f} m/s",
            "half or less of how much the rate varies",
            bool(swing <= 0.5 * np.ptp(rate) / rate.mean()),
        )
    ]


def table(results: Results) -> list[DataTable]:
    """Return what came of each hold time."""
    rows = [
        [
            f"{h:+g}",
            str(run["steps"]),
            f"{rates(run)[SETTLED:].mean():.2f}",
            f"{_length(run):.2f}",
            f"{records(run, 'speed')[SETTLED:].mean():.2f}",
        ]
        for h in HOLDS
        for run in cell([_held(h)], results)
        if run["steps"] > SETTLED
    ]
    head = ["hold [s]", "steps", "strides a second", "step length [m]", "speed [m/s]"]
    return [DataTable("", head, rows)]


FIGURES = (
    Figure(
        "5.13",
        "Stride rate",
        "Hold times that are longer or shorter give stride rates between 0.8 and about 1.25 "
        "strides a second; our human's own rate is faster than the thesis' here.",
        jobs,
        draw_rates,
        claims_rates,
        table,
    ),
    Figure(
        "5.14",
        "Speed while the stride rate varies",
        "Within one walk the stride rate goes down and up again; the speed stays relatively "
        "constant, so that strides get longer as they get slower.",
        lambda quick: [VARIED],
        draw_speed,
        claims_speed,
        size=(7.0, 4.0),
    ),
)
