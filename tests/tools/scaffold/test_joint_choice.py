"""An example moves a joint that bears nothing, as far as it may."""

from pathlib import Path

import numpy as np
import pytest

from tests.shapes import ONE_LEG, write_shape
from windup.hal.errors import UsageError
from windup.robots import load_robot, robot_names
from windup.tools.scaffold.joint_choice import FAR, NEAR, harmless_swing


@pytest.mark.parametrize("name", robot_names())
def test_the_swing_stays_inside_the_limits(name: str) -> None:
    robot = load_robot(name)
    joint, degrees = harmless_swing(robot)
    index = robot.joints.index(joint)
    end = robot.stance[index] + np.radians(degrees)
    assert robot.joints.lower[index] <= end <= robot.joints.upper[index]
    assert 1.0 <= abs(degrees) <= FAR


def test_a_head_or_an_arm_moves_where_there_is_one() -> None:
    assert harmless_swing(load_robot("op3")).joint not in {"l_knee", "r_knee"}
    assert harmless_swing(load_robot("so101")).joint == "gripper"


def test_a_leg_moves_a_little_where_there_is_nothing_else(tmp_path: Path) -> None:
    assert abs(harmless_swing(load_robot(write_shape(tmp_path / "r", ONE_LEG))).degrees) == NEAR


def test_a_robot_without_room_is_refused(tmp_path: Path) -> None:
    file = write_shape(tmp_path / "r", ONE_LEG) / "robot.toml"
    limits = "lower = -1.5, upper = 1.5"
    file.write_text(file.read_text().replace(limits, "lower = -0.01, upper = 0.01"))
    with pytest.raises(UsageError, match="no joint of one_leg can move"):
        harmless_swing(load_robot(file.parent))
