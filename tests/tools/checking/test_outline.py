"""The points of a picture are where the robot has its links, axes, soles and mass."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest

from tests.shapes import ARM, LINK, QUADRUPED, Shape, add_table, write_shape
from windup.robots import load_robot
from windup.tools.checking.outline import outline_of, outline_of_model, sole_outline


def test_a_robot_has_an_axis_a_joint_and_a_sole_a_foot(tmp_path: Path) -> None:
    robot = load_robot(write_shape(tmp_path / "r", QUADRUPED))
    outline = outline_of(robot)
    assert outline.joints == robot.joints.names
    np.testing.assert_allclose(np.linalg.norm(outline.axes, axis=1), 1.0)
    np.testing.assert_allclose(outline.axes[0], [0.0, 1.0, 0.0])
    assert set(outline.soles) == {foot.name for foot in robot.feet}
    sole = outline.soles["front_left"]
    np.testing.assert_allclose(np.ptp(sole, axis=0), [0.12, 0.08, 0.0], atol=1e-9)
    assert outline.floor == pytest.approx(0.3 - 0.03 - 3 * LINK - 0.005)
    np.testing.assert_allclose(outline.com[:2], 0.0, atol=1e-9)


@pytest.mark.parametrize("shape", [QUADRUPED, ARM], ids=lambda shape: shape.name)
def test_a_table_beside_the_robot_has_no_part_in_its_centre_of_mass(
    tmp_path: Path, shape: Shape
) -> None:
    alone, table = (write_shape(tmp_path / name, shape) for name in ("alone", "table"))
    add_table(table)
    com = outline_of(load_robot(alone)).com
    robot = load_robot(table)
    np.testing.assert_allclose(outline_of(robot).com, com)
    bare = [outline_of_model(load_robot(each).spec().compile()).com for each in (alone, table)]
    np.testing.assert_allclose(bare[1], bare[0])


def test_links_go_from_body_to_body(tmp_path: Path) -> None:
    outline = outline_of(load_robot(write_shape(tmp_path / "r", ARM)))
    lengths = np.linalg.norm(np.diff(outline.links, axis=1)[:, 0], axis=1)
    np.testing.assert_allclose(lengths, [0.03, LINK, LINK, LINK])


def test_an_mjcf_alone_has_no_soles(tmp_path: Path) -> None:
    robot = load_robot(write_shape(tmp_path / "r", ARM))
    outline = outline_of_model(robot.spec().compile())
    assert outline.soles == {} and len(outline.joints) == 4


def test_a_tilted_sole_has_all_its_corners() -> None:
    signs = np.array(list(product((-1.0, 1.0), repeat=3)))
    box = signs * [0.06, 0.04, 0.004]
    box[:, 2] += 0.1 * box[:, 0]
    sole = sole_outline(box)
    assert len(sole) == 4
    np.testing.assert_allclose(sole[:, 2], 0.1 * sole[:, 0] - 0.004)


def test_a_foot_of_no_size_has_a_sole_of_none() -> None:
    assert np.ptp(sole_outline(np.zeros((8, 3)))) == 0.0
    assert len(sole_outline(np.zeros((0, 3)))) == 0
