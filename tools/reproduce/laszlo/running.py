"""Figures 3.9 and 4.18: with short hold times the same kind of graph runs."""

from functools import partial
from typing import Any

from windup.tools.reproduce.laszlo.jobs import cell, walked
from windup.tools.reproduce.laszlo.recorder import column, records
from windup.tools.reproduce.laszlo.tours import tour
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Results

SEEDS = 4
STEPS = 60


def _run(robot: str, seed: int) -> Job:
    return tour(robot=robot, gait="run", steps=STEPS, seed=seed)


def jobs(robot: str, quick: bool) -> list[Job]:
    """Return runs of one creature from several seeds."""
    return [_run(robot, seed) for seed in range(1 if quick else SEEDS)]


def draw(robot: str, canvas: Any, results: Results) -> None:
    """Draw the height of the pelvis and the way."""
    height, way = canvas.subplots(1, 2)
    for run in cell(jobs(robot, quick=False), results):
        height.plot(column(run, "time"), column(run, "z"), linewidth=0.8)
        way.plot(column(run, "x"), column(run, "y"))
    height.set(xlabel="time [s]", ylabel="pelvis height [m]")
    way.set(xlabel="x [m]", ylabel="y [m]")
    way.set_aspect("equal", adjustable="datalim")


def claims(robot: str, results: Results) -> list[Claim]:
    """Judge that it runs: 60 steps, and in the air between them."""
    runs = cell(jobs(robot, quick=False), results)
    good = [run for run in runs if walked(run)]
    flights = [run["flights"] / run["steps"] for run in runs if run["steps"]]
    return [
        Claim(
            "balanced by the up vector and the stance hip it runs",
            f"{len(good)} of {len(runs)} run {STEPS} steps",
            "all",
            len(good) == len(runs),
        ),
        Claim(
            "running has a flight phase",
            f"{min(flights, default=0.0):.2f} flights a step at least",
            "0.8 or more",
            min(flights, default=0.0) >= 0.8,
        ),
    ]


def table(robot: str, results: Results) -> list[DataTable]:
    """Return steps, flights and speed of each run."""
    rows = [
        [
            str(job.options["seed"]),
            str(run["steps"]),
            str(run["flights"]),
            f"{run['flight_time'] / run['time']:.0%}",
            f"{records(run, 'speed')[10:].mean():.2f}",
        ]
        for job in jobs(robot, quick=False)
        for run in cell([job], results)
        if run["steps"] > 10
    ]
    return [DataTable("", ["seed", "steps", "flights", "in the air", "speed [m/s]"], rows)]


def _figure(name: str, title: str, statement: str, robot: str) -> Figure:
    return Figure(
        name,
        title,
        statement,
        partial(jobs, robot),
        partial(draw, robot),
        partial(claims, robot),
        partial(table, robot),
        size=(10.0, 3.5),
    )


FIGURES = (
    _figure(
        "3.9",
        "A running human",
        "The base graph describes running as well as walking, by its hold times. Our running graph "
        "was found by `windup synthesise`.",
        "human",
    ),
    _figure(
        "4.18",
        "A running robo-bird",
        "A base graph of its own, balanced like the human's, makes the robo-bird run.",
        "robobird",
    ),
)
