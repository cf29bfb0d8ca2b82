"""Figures 5.10 and 5.11: walking to points, and along a set of them."""

from typing import Any

import numpy as np

from windup.tools.reproduce.laszlo.jobs import cell
from windup.tools.reproduce.laszlo.recorder import column
from windup.tools.reproduce.laszlo.tours import tour
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results

WAY = 6.0  # m to each point
BEARINGS = (45, -45, 90, -90, 150)  # degrees
FEW = (-90,)
NEAR = 1.0  # m; the thesis goes on to the next point at more than a turning diameter
SIDE = 6.0  # m, of the square
PASSED = 1.0  # m


def _point(bearing: float) -> tuple[float, float]:
    angle = np.radians(bearing)
    return round(float(WAY * np.cos(angle)), 3), round(float(WAY * np.sin(angle)), 3)


def _to(bearing: float) -> Job:
    return tour(to=list(_point(bearing)), steps=120)


def _square(servo: bool) -> Job:
    return tour(path=f"square:{SIDE:g}", torso_servo=servo, steps=160)


def point_jobs(quick: bool) -> list[Job]:
    """Return walks to points all around."""
    return [_to(bearing) for bearing in (FEW if quick else BEARINGS)]


def path_jobs(quick: bool) -> list[Job]:
    """Return walks around a square, with the torso servo and without."""
    return [_square(True)] if quick else [_square(True), _square(False)]


def closest(result: Result, point: tuple[float, float]) -> float:
    """Return how close the pelvis came to a point, m."""
    x, y = column(result, "x"), column(result, "y")
    return float(np.hypot(x - point[0], y - point[1]).min()) if len(x) else float("nan")


def draw_points(canvas: Any, results: Results) -> None:
    """Draw the ways from above, and the points."""
    axis = canvas.subplots()
    for i, bearing in enumerate(BEARINGS):
        for run in cell([_to(bearing)], results):
            axis.plot(column(run, "x"), column(run, "y"), color=f"C{i}", label=f"{bearing}")
            axis.plot(*_point(bearing), "o", color=f"C{i}")
    axis.set(xlabel="x [m]", ylabel="y [m]")
    axis.set_aspect("equal", adjustable="datalim")
    axis.legend(fontsize="small", title="degrees")


def claims_points(results: Results) -> list[Claim]:
    """Judge that each point is reached."""
    came = {b: closest(run, _point(b)) for b in BEARINGS for run in cell([_to(b)], results)}
    text = ", ".join(f"{bearing}: {away:.2f} m" for bearing, away in came.items())
    return [
        Claim(
            "a turn in proportion to the direction of a point leads there",
            f"closest, by degrees from the first heading: {text}",
            f"each within {NEAR:g} m",
            all(away <= NEAR for away in came.values()),
        )
    ]


def draw_path(canvas: Any, results: Results) -> None:
    """Draw the square and the ways around it."""
    axis = canvas.subplots()
    corners = np.array([*_corners(), _corners()[0]])
    axis.plot(corners[:, 0], corners[:, 1], "k--", linewidth=0.8)
    for servo, color in ((True, "tab:blue"), (False, "tab:orange")):
        for run in cell([_square(servo)], results):
            label = "torso servo" if servo else "no torso servo"
            axis.plot(column(run, "x"), column(run, "y"), color=color, label=label)
    axis.set(xlabel="x [m]", ylabel="y [m]")
    axis.set_aspect("equal", adjustable="datalim")
    axis.legend(fontsize="small")


def _corners() -> list[tuple[float, float]]:
    return [(0.0, 0.0), (SIDE, 0.0), (SIDE, SIDE), (0.0, SIDE)]


def claims_path(results: Results) -> list[Claim]:
    """Judge that every corner is passed."""
    claims = []
    for servo, word in ((True, "with"), (False, "without")):
        for run in cell([_square(servo)], results):
            worst = max(closest(run, corner) for corner in _corners()[1:])
            claims.append(
                Claim(
                    f"a set of points is followed {word} torso servo",
                    f"worst corner passed at {worst:.2f} m, {run['steps']} steps, "
                    f"{'fell' if run['fell'] else 'no fall'}",
                    f"{PASSED:g} m or less",
                    bool(run["arrived"] and worst <= PASSED),
                )
            )
    return claims


def table_points(results: Results) -> list[DataTable]:
    """Return steps and nearness of each walk."""
    rows = [
        [f"{b}", str(run["steps"]), f"{closest(run, _point(b)):.2f}", str(run["arrived"])]
        for b in BEARINGS
        for run in cell([_to(b)], results)
    ]
    return [DataTable("", ["bearing [deg]", "steps", "closest [m]", "arrived"], rows)]


FIGURES = (
    Figure(
        "5.10",
        "Point following",
        "The turning perturbation, scaled in proportion to the angle between the facing direction "
        "and a point, leads the biped to it.",
        point_jobs,
        draw_points,
        claims_points,
        table_points,
        size=(6.0, 5.0),
    ),
    Figure(
        "5.11",
        "Path following",
        "Points followed one after the other make a path, with and without torso servo. Ours looks "
        "ahead along the path instead of at its next point.",
        path_jobs,
        draw_path,
        claims_path,
        size=(6.0, 5.0),
    ),
)
