"""A wrong sign and swapped ids, told by soles that would not lie on the floor."""

from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from windup.control.kinematics.legs import Legs, legs_of
from windup.control.motions.planted import Planted
from windup.hal.joints import Array
from windup.hal.observation import BaseState, JointState, Observation
from windup.robots import RobotDescription, load_robot

Reading = Callable[[Array], Array]
"""What joints (n,) rad are read as."""


def legs(robot: RobotDescription) -> Legs:
    model, feet = robot.spec().compile(), [foot.body for foot in robot.feet]
    found = legs_of(model, robot.base, feet, robot.joints, robot.stance)
    assert found is not None
    return found


def seen(position: Array, up: Array) -> Observation:
    """Return what is seen of joints (n,) rad with the vertical (3,) in the base."""
    turn, zero = np.empty(4), np.zeros_like(position)
    mujoco.mju_quatZ2Vec(turn, up)
    turn[1:] *= -1.0
    base = BaseState(np.zeros(3), turn, np.zeros(3), np.zeros(3))
    state = JointState(position, zero, zero, zero, zero, zero, zero)
    return Observation(0.0, state, None, np.zeros(0), base)


def told(robot: RobotDescription, read: Reading, *, hangs: bool = False) -> str | None:
    """Return what is said while a robot stands up from half its crouch, flat on its soles."""
    where, watch = legs(robot), Planted(robot.joints, legs(robot))
    assert robot.crouch is not None
    middle = robot.stance + 0.5 * (robot.crouch - robot.stance)
    for share in np.linspace(0.0, 1.0, 400):
        pose = middle + share * (robot.stance - middle)
        up = where.soles(pose[None])[0][0].mean(axis=0)
        up = np.array([0.05, 0.0, 1.0]) if hangs else up
        if (wrong := watch.update(seen(read(pose), up / np.linalg.norm(up)))) is not None:
            return wrong
    return None


def flipped(robot: RobotDescription, name: str) -> Reading:
    joint = robot.joints.index(name)
    return lambda pose: np.where(np.arange(len(pose)) == joint, -pose, pose)


def swapped(robot: RobotDescription, one: str, other: str) -> Reading:
    order = np.arange(len(robot.joints))
    pair = robot.joints.indices([one, other])
    order[pair] = order[pair[::-1]]
    return lambda pose: pose[order]


def test_the_soles_are_where_mujoco_has_them(op3: RobotDescription) -> None:
    model = op3.spec().compile()
    data, rng = mujoco.MjData(model), np.random.default_rng(1)
    where = legs(op3)
    poses = rng.uniform(op3.joints.lower, op3.joints.upper, size=(4, len(op3.joints)))
    normals, middles = where.soles(poses)
    for pose, normal, middle in zip(poses, normals, middles, strict=True):
        data.qpos[:7], data.qpos[7:] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], pose
        mujoco.mj_kinematics(model, data)
        for row, foot in enumerate(op3.feet):
            body = data.body(foot.body)
            frame = body.xmat.reshape(3, 3)
            np.testing.assert_allclose(normal[row], frame @ where.normal[row], atol=1e-12)
            there = body.xpos + frame @ where.middle[row]
            np.testing.assert_allclose(middle[row], there, atol=1e-12)


def test_the_soles_of_a_stance_point_up_and_are_level(op3: RobotDescription) -> None:
    normals, middles = legs(op3).soles(op3.stance[None])
    assert normals[0, :, 2] == pytest.approx([1.0, 1.0], abs=0.01)
    assert middles[0, 0, 2] == pytest.approx(middles[0, 1, 2], abs=0.002)


def test_a_robot_whose_soles_lie_flat_has_nothing_wrong(op3: RobotDescription) -> None:
    assert told(op3, lambda pose: pose) is None


@pytest.mark.parametrize("name", ["l_knee", "r_hip_pitch", "l_ank_pitch"])
def test_a_wrong_sign_is_named(op3: RobotDescription, name: str) -> None:
    wrong = told(op3, flipped(op3, name))
    assert wrong is not None and wrong.startswith(f"{name} turns the other way")
    assert "degrees off the floor" in wrong


def test_swapped_ids_are_named(op3: RobotDescription) -> None:
    wrong = told(op3, swapped(op3, "r_hip_roll", "r_hip_pitch"))
    assert wrong is not None
    assert wrong.startswith("r_hip_roll and r_hip_pitch are swapped (are their ids right")


def test_legs_of_other_lengths_are_told_by_the_height_of_the_soles() -> None:
    duck = load_robot("duck")
    wrong = told(duck, swapped(duck, "left_knee", "left_ankle"))
    assert wrong is not None
    assert "left_knee and left_ankle are swapped" in wrong


def test_a_robot_that_hangs_is_not_judged(op3: RobotDescription) -> None:
    assert told(op3, flipped(op3, "l_knee"), hangs=True) is None


def test_without_an_attitude_nothing_is_judged(op3: RobotDescription) -> None:
    watch = Planted(op3.joints, legs(op3))
    blind = seen(flipped(op3, "l_knee")(op3.stance), np.array([0.0, 0.0, 1.0]))
    object.__setattr__(blind, "base", None)
    assert all(watch.update(blind) is None for _ in range(50))
