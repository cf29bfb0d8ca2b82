"""Where a walk goes: a point, a path from a file, a circle or a square."""

import csv
from math import radians
from pathlib import Path

import numpy as np

from windup.control.pose_graph.gait import Gait
from windup.control.steering.guide import Guide
from windup.control.steering.navigation import Agility, PathFollower, PointFollower, circle, square
from windup.hal.errors import UsageError
from windup.hal.joints import Array
from windup.hal.ranges import Range, read_number
from windup.hal.small_file import read_small
from windup.robots import RobotDescription

MOST = 10_000
"""Points of a path."""
WHERE = Range(-10_000.0, 10_000.0, "m")
SIZE = Range(0.0, 10_000.0, "m", above=True)


def guide_of(
    robot: RobotDescription,
    gait: Gait,
    *,
    path: str | None = None,
    to: tuple[float, float] | None = None,
    speed: float | None = None,
) -> Guide | None:
    """Return who leads a walk along `path` or `to` a point; None if nobody has to.

    Args:
        robot: The robot; its height is the measure of how far it looks ahead.
        gait: The gait; it has to be able to turn, and looks ahead at least as far as its radius,
            else it overshoots every corner.
        path: A CSV file of x,y waypoints, "circle:RADIUS" or "square:SIDE".
        to: x, y of a point, m.
        speed: m/s.

    Raises:
        UsageError: Both are given, the gait cannot turn, or the path is too tight.
    """
    if path is None and to is None:
        return None
    if path is not None and to is not None:
        raise UsageError("give --path or --to, not both")
    agility = agility_of(gait, speed)
    tall = float(robot.spec().body(robot.base).pos[2])
    if to is not None:
        return PointFollower(np.array(to), agility, near=0.3 * tall)
    points, closed = read_path(str(path))
    return PathFollower(points, agility, look_ahead=max(tall, agility.radius), closed=closed)


def agility_of(gait: Gait, speed: float | None) -> Agility:
    """Return what a gait can do on a path.

    Raises:
        UsageError: It cannot turn.
    """
    turn, table = gait.file.turn, gait.file.speed
    if turn is None:
        raise UsageError(f"gait {gait.name!r} cannot turn; a path needs a [turn] table")
    fast = table.default or table.begin if speed is None and table is not None else speed
    slow = None if fast is None else min(fast, turn.speed)
    return Agility(fast, radians(turn.limit), turn.radius, slow)


def read_path(text: str) -> tuple[Array, bool]:
    """Return the points (p, 2) of a path, m, and whether it is closed.

    >>> read_path("square:2")[0].tolist()
    [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]

    Raises:
        UsageError: There is no such file, or it has no points.
    """
    kind, colon, size = text.partition(":")
    if colon and kind in ("circle", "square"):
        return (circle if kind == "circle" else square)(_metres(text, size)), True
    try:
        rows = list(csv.reader(read_small(Path(text)).decode("utf-8-sig").splitlines()))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise UsageError(
            f"--path {text}: {why}; give a CSV of x,y, circle:RADIUS or square:SIDE"
        ) from None
    points = [_point(text, number, row) for number, row in enumerate(rows, 1) if _holds_point(row)]
    if not 2 <= len(points) <= MOST:
        raise UsageError(f"--path {text}: {len(points)} points; give 2 .. {MOST} lines of x,y")
    return np.array(points).reshape(-1, 2), False


def _holds_point(row: list[str]) -> bool:
    """Return False for empty lines, comments and a heading of words."""
    return bool(row) and not row[0].lstrip().startswith("#") and row[0].strip().lower() != "x"


def _point(text: str, number: int, row: list[str]) -> list[float]:
    if len(row) != 2:
        raise UsageError(f"--path {text}: line {number} is not x,y")
    return [read_number(f"--path {text}: line {number}", value, WHERE) for value in row]


def _metres(text: str, size: str) -> float:
    return read_number(f"--path {text}", size, SIZE)
