"""Following points and paths, with a walker that is a point."""

from math import cos, pi, radians, sin

import numpy as np
import pytest

from windup.control.steering.guide import Guide, Place
from windup.control.steering.navigation import (
    Agility,
    PathFollower,
    PointFollower,
    checked,
    circle,
    square,
)
from windup.hal.errors import UsageError
from windup.hal.geometry.angles import wrapped
from windup.hal.joints import Array
from windup.tools.assembly.route import read_path

NIMBLE = Agility(speed=0.2, turn=radians(45.0), slow=0.0)
CAR = Agility(speed=0.8, turn=radians(20.0), radius=2.5)


def stroll(guide: Guide, steps: int, period: float = 0.25) -> Array:
    """Return the way (t, 2) of a point that obeys `guide` exactly."""
    position, heading, way = np.zeros(2), 0.0, []
    for _ in range(steps):
        order = guide.command(Place(position.copy(), heading, 0.0))
        if order.stop:
            break
        assert order.direction is not None and order.speed is not None
        most = order.turn * period
        heading += float(np.clip(wrapped(order.direction - heading), -most, most))
        position += order.speed * period * np.array([cos(heading), sin(heading)])
        way.append(position.copy())
    return np.array(way)


@pytest.mark.parametrize("point", [(1.0, 0.0), (0.0, 1.0), (-1.0, -0.5)])
def test_a_point_is_reached_from_any_side(point: tuple[float, float]) -> None:
    follower = PointFollower(np.array(point), NIMBLE, near=0.1)
    way = stroll(follower, 400)
    assert follower.done
    assert follower.passed(way)[0] < 0.11


def test_a_square_is_walked_once_round() -> None:
    follower = PathFollower(square(10.0), CAR, look_ahead=1.0, closed=True)
    way = stroll(follower, 400)
    assert follower.done
    assert follower.passed(way).max() < 1.0
    assert np.linalg.norm(way[-1]) < 1.0


def test_an_open_path_ends_at_its_last_point() -> None:
    follower = PathFollower(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]), NIMBLE, 0.3)
    way = stroll(follower, 400)
    assert follower.done
    assert np.linalg.norm(way[-1] - [1.0, 1.0]) < 0.15


def test_a_corner_that_is_too_tight_is_refused_with_the_room_it_needs() -> None:
    with pytest.raises(UsageError, match=r"corner at \(3, 0\) is too tight: 90 degrees need legs"):
        checked(np.array([[0, 0], [3, 0], [3, 3]]), CAR, closed=False)
    checked(np.array([[0, 0], [6, 0], [6, 6]]), CAR, closed=False)


def test_turning_back_needs_a_robot_that_turns_on_the_spot() -> None:
    there_and_back = np.array([[0, 0], [9, 0], [0, 0]])
    checked(there_and_back, NIMBLE, closed=False)
    with pytest.raises(UsageError, match="180 degrees"):
        checked(there_and_back, CAR, closed=False)


def test_a_circle_begins_straight_ahead() -> None:
    points = circle(2.0)
    assert points[0] == pytest.approx([0.0, 0.0])
    assert points[18] == pytest.approx([2.0, 2.0])
    assert points[1, 1] < 0.1 * points[1, 0]
    assert wrapped(1.5 * pi) == pytest.approx(-0.5 * pi)


def test_a_path_file_may_have_a_heading_and_comments(tmp_path) -> None:  # type: ignore[no-untyped-def]
    file = tmp_path / "path.csv"
    file.write_text("x,y\n# home\n0,0\n1, 0.5\n\n")
    points, closed = read_path(str(file))
    assert points.tolist() == [[0.0, 0.0], [1.0, 0.5]]
    assert not closed
    file.write_text("0,0\n1,one\n")
    with pytest.raises(UsageError, match="line 2: 'one' is no number"):
        read_path(str(file))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("circle:big", "'big' is no number"),
        ("circle:nan", "give a finite number of m"),
        ("square:-1", "give more than 0, up to 10000 m"),
        ("square:", "'' is no number"),
    ],
)
def test_a_shape_needs_a_length(text: str, said: str) -> None:
    with pytest.raises(UsageError, match=f"--path {text}: .*{said}"):
        read_path(text)
