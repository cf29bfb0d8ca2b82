"""Joints that are not simply a servo's horn: linkages with a ratio, passive joints, couplings."""

from pathlib import Path

import numpy as np
import pytest

from tests.shapes import Limb, Shape, write_shape
from windup.hal.command import JointCommand
from windup.robots import RobotDescription, load_robot
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.joint_indices import as_index
from windup.sim_twin.twin import Twin
from windup.tools.testing.servo_bus import ServoBus

ONE = Shape("one", (Limb("arm", "0 0 0.03", 1, "z", down=False),), floats=False, height=0.03)
FINGER = """<body name="finger" pos="0 0 0.1">
<joint name="finger" axis="0 0 1" armature="0.001" damping="0.01"/>
<geom type="box" size="0.01 0.01 0.02" mass="0.01"/></body>"""
COUPLED = '<equality><joint joint1="finger" joint2="arm_0" polycoef="0 -0.5 0 0 0"/></equality>'


def geared(folder: Path, ratio: float) -> RobotDescription:
    """Return a robot with one joint that turns for ever, `ratio` turns of its servo a turn."""
    path = write_shape(folder / f"ratio{ratio:g}", ONE)
    model, file = path / "model.xml", path / "robot.toml"
    model.write_text(
        model.read_text().replace('range="-1.5 1.5"', "").replace('frictionloss="0.02"', "")
    )
    file.write_text(file.read_text().replace("id = 1,", f"id = 1, ratio = {ratio},"))
    return load_robot(path)


def coupled(folder: Path) -> Path:
    """Write a robot whose passive finger, before its joint, turns half as far the other way."""
    path = write_shape(folder / "coupled", ONE)
    model, file = path / "model.xml", path / "robot.toml"
    text = model.read_text().replace('<site name="imu"/>', f'<site name="imu"/>{FINGER}')
    model.write_text(text.replace("</mujoco>", f"{COUPLED}</mujoco>"))
    file.write_text('passive = ["finger"]\n' + file.read_text())
    return path


def test_places_that_follow_each_other_are_a_view() -> None:
    assert as_index(np.array([7, 8, 9])) == slice(7, 10)
    np.testing.assert_array_equal(as_index(np.array([0, 2])), [0, 2])


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_a_linkage_trades_speed_for_torque_in_the_twin(tmp_path: Path, ratio: float) -> None:
    robot = geared(tmp_path, ratio)
    twin = Twin(robot)
    twin.set_goals(np.array([1e4]))
    twin.step(1)
    assert twin.data.actuator_force[0] == pytest.approx(4.1 * ratio, rel=0.05)
    twin.step(3000)
    assert twin.data.qvel[0] == pytest.approx(robot.joints.velocity[0], rel=0.02)


@pytest.mark.parametrize("ratio", [0.5, 2.0])
def test_stiffness_is_that_of_the_joint_behind_any_linkage(tmp_path: Path, ratio: float) -> None:
    robot = geared(tmp_path, ratio)
    backend = TwinBackend(Twin(robot))
    real = backend.write(JointCommand.hold(robot.joints, np.array([0.1])))
    servo = robot.servos[0]
    assert servo is not None
    unit = ratio**2 * servo.model.stiffness(1.0, robot.drive.supply)
    assert abs(real.stiffness[0] - robot.joints.stiffness[0]) <= unit / 2
    count = 2.0 * np.pi / (servo.model.counts_per_rev * ratio)
    assert abs(real.position[0] - 0.1) <= count / 2


@pytest.mark.parametrize("ratio", [0.5, 2.0])
def test_a_linkage_is_the_same_through_the_bus(tmp_path: Path, ratio: float) -> None:
    robot = geared(tmp_path, ratio)
    with ServoBus(str(robot.folder)) as bus:
        opened = bus.robot()
        opened.play("nod", 1.0)
        assert opened.backend.read().joints.position[0] == pytest.approx(0.0, abs=0.02)


def test_a_coupled_joint_obeys_its_equality_and_is_no_joint_of_ours(tmp_path: Path) -> None:
    robot = load_robot(coupled(tmp_path))
    backend = TwinBackend(Twin(robot))
    twin = backend.twin
    twin.set_goals(np.array([0.6]))
    twin.step(500)
    seen = backend.read().joints
    assert seen.position == pytest.approx([0.6], abs=0.03)
    assert twin.data.joint("finger").qpos[0] == pytest.approx(-0.3, abs=0.03)
    assert seen.velocity.shape == (1,)


def test_a_passive_joint_does_not_shift_the_shafts_of_the_bus(tmp_path: Path) -> None:
    with ServoBus(str(coupled(tmp_path))) as bus:
        robot = bus.robot()
        assert robot.play("nod", 1.0).reason == "done"
        at = robot.twin.data.joint("arm_0").qpos[0]
        assert robot.backend.read().joints.position[0] == pytest.approx(at, abs=0.005)
