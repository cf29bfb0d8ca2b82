"""Joints that follow others: what robot.toml says of them, and what the twin makes of it."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.shapes import Limb, Shape, write_shape
from windup.hal.errors import ConfigError
from windup.robots import RobotDescription, load_robot
from windup.sim_twin.twin import Twin

ONE = Shape("one", (Limb("arm", "0 0 0.03", 1, "z", down=False),), floats=False, height=0.03)
FINGER = """<body name="finger" pos="0 0 0.1">
<joint name="finger" {} armature="0.001" damping="0.01"/>
<geom type="box" size="0.01 0.01 0.02" mass="0.01"/></body>"""
HINGE, SLIDE = 'axis="0 0 1"', 'type="slide" axis="0 0 1"'
Follow = Callable[..., RobotDescription]


@pytest.fixture
def follow(tmp_path: Path) -> Follow:
    """Return what loads a robot with a finger that follows its joint as a table says."""

    def load(table: str, joint: str = HINGE, mjcf: str = "") -> RobotDescription:
        path = write_shape(tmp_path / "one", ONE)
        model, file = path / "model.xml", path / "robot.toml"
        text = model.read_text().replace('<site name="imu"/>', FINGER.format(joint))
        model.write_text(text.replace("</mujoco>", f"{mjcf}</mujoco>"))
        file.write_text(file.read_text().replace("[poses", f"[[coupling]]\n{table}\n[poses"))
        return load_robot(path)

    return load


@pytest.mark.parametrize(
    ("joint", "ratio", "offset"),
    [
        (HINGE, 1.0, 0.0),
        (HINGE, -0.5, 0.2),
        (SLIDE, 0.02, 0.01),
        (HINGE + ' ref="0.3"', -0.5, 0.2),
    ],
)
def test_a_follower_goes_where_its_coupling_says(
    follow: Follow, joint: str, ratio: float, offset: float
) -> None:
    robot = follow(
        f'joint = "finger"\nfollows = "arm_0"\nratio = {ratio}\noffset = {offset}', joint
    )
    assert (robot.joints.names, robot.passive) == (("arm_0",), ("finger",))
    twin = Twin(robot)
    twin.set_goals(np.array([0.6]))
    twin.step(1000)
    there = twin.data.joint("arm_0").qpos[0]
    assert there == pytest.approx(0.6, abs=0.03)
    assert twin.data.joint("finger").qpos[0] == pytest.approx(offset + ratio * there, abs=0.003)


EQUALITY = '<equality><joint joint1="{}" joint2="{}" polycoef="{}"/></equality>'
FREE = 'joint = "finger"\nfollows = "arm_0"'


@pytest.mark.parametrize(
    ("mjcf", "angle"),
    [
        (EQUALITY.format("finger", "arm_0", "0.1 -0.5 2 0 0"), 0.1 - 0.2 + 0.32),
        (EQUALITY.format("arm_0", "finger", "0.1 -0.5 0 0 0"), -0.6),
    ],
)
def test_a_reset_puts_what_the_mjcf_couples_in_step(
    tmp_path: Path, mjcf: str, angle: float
) -> None:
    path = write_shape(tmp_path / "one", ONE)
    model, file = path / "model.xml", path / "robot.toml"
    text = model.read_text().replace('<site name="imu"/>', FINGER.format(HINGE))
    model.write_text(text.replace("</mujoco>", f"{mjcf}</mujoco>"))
    file.write_text('passive = ["finger"]\n' + file.read_text())
    twin = Twin(load_robot(path))
    twin.reset(np.array([0.4]))
    assert twin.data.joint("finger").qpos[0] == pytest.approx(angle)


MISTAKES = {
    "an unknown follower": ('joint = "fingre"\nfollows = "arm_0"', "did you mean 'finger'"),
    "an unknown driver": ('joint = "finger"\nfollows = "arm_1"', "did you mean 'arm_0'"),
    "a joint with a servo": (
        f'{FREE}\n[[coupling]]\njoint = "arm_0"\nfollows = "arm_0"',
        "is a [[joint]] as well",
    ),
    "said twice": (f"{FREE}\n[[coupling]]\n{FREE}", "coupled twice"),
    "out of its range": (f"{FREE}\nratio = 2", "from -3 to 3 rad, and its range in the MJCF"),
}


@pytest.mark.parametrize(("table", "said"), MISTAKES.values(), ids=MISTAKES.keys())
def test_a_coupling_that_cannot_be_is_one_line(follow: Follow, table: str, said: str) -> None:
    with pytest.raises(ConfigError) as error:
        follow(table, HINGE + ' range="-2 2"')
    assert said in str(error.value)
    assert "coupling" in str(error.value) and "\n" not in str(error.value)


def test_what_the_mjcf_couples_already_is_not_coupled_again(follow: Follow) -> None:
    with pytest.raises(ConfigError, match="by an <equality> of the MJCF"):
        follow(FREE, mjcf=EQUALITY.format("finger", "arm_0", "0 1 0 0 0"))
