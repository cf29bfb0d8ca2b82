"""What is doubtful about how a robot stands is said, with what would be right."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.shapes import THIRTY, write_shape
from windup.robots import load_robot, robot_names
from windup.robots.inspection.posture_warnings import balance_margin
from windup.robots.inspection.robot_warnings import robot_warnings

SQUARE = np.array([[0.1, 0.1], [0.1, -0.1], [-0.1, 0.1], [-0.1, -0.1]])


def doubted(folder: Path, file: str, *changes: tuple[str, str]) -> str:
    """Return the doubts about a robot with two feet, some words of a file of which are changed."""
    path = write_shape(folder / "r", THIRTY) / file
    text = path.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    return "\n".join(robot_warnings(load_robot(path.parent)))


@pytest.mark.parametrize(("x", "margin"), [(0.0, 0.1), (0.06, 0.04), (0.13, -0.03)])
def test_the_margin_of_balance_is_the_way_to_the_edge(x: float, margin: float) -> None:
    assert balance_margin(SQUARE, np.array([x, 0.0])) == pytest.approx(margin, abs=1e-4)


def test_a_robot_that_stands_raises_no_doubt(tmp_path: Path) -> None:
    assert doubted(tmp_path, "robot.toml", ("rate_hz", "rate_hz")) == ""


@pytest.mark.parametrize("name", robot_names())
def test_robots_of_the_package_stand_in_their_stance(name: str) -> None:
    said = "\n".join(robot_warnings(load_robot(name)))
    for words in ("in the stance", "is called left", "put it in the middle", "counts as fallen"):
        assert words not in said


def test_feet_of_no_side_are_doubted(tmp_path: Path) -> None:
    said = doubted(tmp_path, "robot.toml", ('name = "left"', 'name = "paw"'))
    assert 'no side of foot \'paw\': give side = "left" or "right" to walk' in said


def test_a_left_foot_on_the_right_is_doubted(tmp_path: Path) -> None:
    one = ('name = "left"', 'name = "a"\nside = "right"')
    other = ('name = "right"', 'name = "b"\nside = "left"')
    said = doubted(tmp_path, "robot.toml", one, other)
    assert "foot 'b' is called left and is 0.14 m to the right of 'a'" in said


def test_a_site_that_is_not_on_the_sole_is_doubted(tmp_path: Path) -> None:
    site = ('name="left_sole" pos="0 0 -0.065"', 'name="left_sole" pos="0 0 -0.025"')
    said = doubted(tmp_path, "model.xml", site)
    assert "site 'left_sole' is 40 mm above the lowest point of foot 'left'" in said
    assert "in the stance foot 'left' is 40 mm higher than 'right'" in said


def test_a_sole_that_is_tilted_in_the_stance_is_doubted(tmp_path: Path) -> None:
    folder = write_shape(tmp_path / "r", THIRTY)
    robot = load_robot(folder)
    pose = robot.stance.copy()
    ankle = next(i for i in reversed(range(6)) if robot.model.joint(f"left_{i}").axis[1])
    pose[robot.joints.names.index(f"left_{ankle}")] += np.radians(25.0)
    said = "\n".join(robot_warnings(replace(robot, stance=pose)))
    assert "in the stance the sole of foot 'left' is tilted by 25 degrees: correct" in said
    assert "put it in the middle of the sole" not in said


def test_a_centre_of_mass_outside_of_the_soles_is_doubted(tmp_path: Path) -> None:
    trunk = ('size="0.12 0.08 0.03" mass="0.4"', 'size="0.12 0.08 0.03" pos="0.3 0 0" mass="4"')
    said = doubted(tmp_path, "model.xml", trunk)
    assert "in the stance the centre of mass is" in said and "it topples" in said


def test_a_robot_that_counts_as_fallen_where_it_stands_is_doubted(tmp_path: Path) -> None:
    said = doubted(tmp_path, "robot.toml", ("height = 0.05", "height = 0.5"))
    assert "fall.height 0.5 m: in the stance body 'trunk' is 0.395 m above the soles" in said


def test_joints_stronger_and_faster_than_their_servos_are_doubted(tmp_path: Path) -> None:
    joint = ("id = 1,", "id = 1, torque = 40.0, velocity = 50.0,")
    said = doubted(tmp_path, "robot.toml", joint)
    assert "joint 'left_0': torque 40 N m is more than the 4.1 N m at stall" in said
    assert "joint 'left_0': velocity 50 rad/s is more than the" in said


def test_another_gravity_is_doubted(tmp_path: Path) -> None:
    option = ('timestep="0.002"', 'timestep="0.002" gravity="0 0 0"')
    assert "gravity is 0 0 0 m/s2" in doubted(tmp_path, "model.xml", option)
