"""Where a walk goes."""

import pytest

from windup.control.steering.navigation import PathFollower
from windup.robots import load_robot
from windup.tools.assembly.gaits import find_gait
from windup.tools.assembly.route import guide_of


@pytest.mark.parametrize(("name", "far"), [("human", 2.4), ("op3", None)])
def test_a_robot_looks_as_far_ahead_as_it_turns_wide(name: str, far: float | None) -> None:
    robot = load_robot(name)
    guide = guide_of(robot, find_gait(robot, "walk"), path="square:10")
    assert isinstance(guide, PathFollower)
    tall = float(robot.spec().body(robot.base).pos[2])
    assert guide.look_ahead == pytest.approx(far or tall)
