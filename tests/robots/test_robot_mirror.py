import mujoco
import numpy as np
import pytest

from windup.hal.errors import ConfigError
from windup.robots import RobotDescription, load_robot
from windup.robots.mirror import mirror_map

ROBOTS = ["op3", "human", "human12", "robobird", "duck", "human_handstand"]
CROOKED = {"duck": 4e-3}  # its legs are not quite mirror images; m


@pytest.mark.parametrize("name", ROBOTS)
def test_a_mirrored_pose_is_the_mirror_image_in_space(name: str) -> None:
    robot = load_robot(name)
    pose = np.random.default_rng(1).uniform(-0.3, 0.3, len(robot.joints))
    left, right = feet_and_com(robot, pose), feet_and_com(robot, robot.mirror(pose))
    flip = np.array([1.0, -1.0, 1.0])
    np.testing.assert_allclose(right[[1, 0]], left[:2] * flip, atol=CROOKED.get(name, 1e-9))
    np.testing.assert_allclose(right[2], left[2] * flip, atol=2e-3)  # op3 is not quite symmetric


def feet_and_com(robot: RobotDescription, pose: np.ndarray) -> np.ndarray:
    model = robot.spec().compile()
    data = mujoco.MjData(model)
    data.qpos[7:] = pose
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    feet = [data.site(foot.site).xpos for foot in robot.feet]
    return np.array([*feet, data.subtree_com[1]])


@pytest.mark.parametrize("name", ROBOTS)
def test_mirroring_twice_changes_nothing(name: str) -> None:
    robot = load_robot(name)
    pose = np.random.default_rng(2).uniform(-1, 1, (3, len(robot.joints)))
    np.testing.assert_array_equal(robot.mirror(robot.mirror(pose)), pose)


def test_op3s_servos_are_mounted_mirrored() -> None:
    robot = load_robot("op3")
    sign = dict(zip(robot.joints.names, robot.mirror.sign, strict=True))
    assert {sign[f"{s}_{j}"] for s in "lr" for j in ("hip_pitch", "knee", "ank_pitch")} == {-1.0}
    assert (sign["head_pan"], sign["head_tilt"]) == (-1.0, 1.0)


def test_the_human_keeps_pitch_and_negates_roll_and_yaw() -> None:
    robot = load_robot("human")
    sign = dict(zip(robot.joints.names, robot.mirror.sign, strict=True))
    assert sign["l_hip_roll"] == sign["r_ankle_roll"] == sign["l_hip_yaw"] == -1.0
    assert sign["l_hip_pitch"] == sign["r_knee"] == sign["l_elbow"] == sign["waist"] == 1.0


def test_a_missing_partner_is_named() -> None:
    with pytest.raises(ConfigError, match="'l_arm' has no partner 'r_arm'"):
        mirror_map(("l_arm",), np.array([[0.0, 1.0, 0.0]]))


def test_a_crooked_partner_is_named() -> None:
    axes = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    with pytest.raises(ConfigError, match="'l_arm' is not the mirror image of 'r_arm'"):
        mirror_map(("l_arm", "r_arm"), axes)
