from math import radians

import numpy as np
import pytest

from windup.control.pose_graph.gait_file import Heading, Turn
from windup.control.steering.course import Course
from windup.control.steering.guide import WalkCommand


def course(direction: float = 0.0) -> Course:
    return Course(Heading(perturbation="turn", gain=0.5, limit=6.0), direction=direction)


@pytest.mark.parametrize(
    ("degrees", "scale"), [(0.0, 0.0), (-4.0, 2.0), (4.0, -2.0), (-90.0, 6.0), (90.0, -6.0)]
)
def test_it_turns_back_in_proportion_and_within_its_limit(degrees: float, scale: float) -> None:
    assert course().scale(np.radians(degrees)) == pytest.approx(scale)


def test_it_takes_the_short_way_round() -> None:
    assert course(np.radians(179.0)).scale(np.radians(-179.0)) == pytest.approx(-1.0)
    assert course(np.radians(-179.0)).scale(np.radians(179.0)) == pytest.approx(1.0)
    assert course().scale(2.0 * np.pi) == pytest.approx(0.0)


def test_it_says_which_perturbation_turns() -> None:
    assert course().perturbation == "turn"


def test_it_begins_to_end_a_turn_in_time_and_does_not_swing_past() -> None:
    course = Course(Heading("turn", gain=0.5), Turn(limit=50.0, ramp=3.0))
    order = WalkCommand(turn=radians(50.0), direction=radians(38.0))
    ways = []
    for _ in range(60):
        course.begin_step(order, course.direction, duration=0.25)
        ways.append(course.direction)
    assert max(ways) == pytest.approx(radians(38.0), abs=radians(0.3))
    assert ways[-1] == pytest.approx(radians(38.0), abs=radians(0.1))
