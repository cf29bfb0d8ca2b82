from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
import pytest
from shapely import MultiPoint

from windup.control.kinematics.robot_state import PER_OBSERVATION, RobotState
from windup.hal.errors import StateMissingError
from windup.hal.observation import BaseState, JointState, Observation
from windup.robots import RobotDescription
from windup.tools.assembly.state import state_of

AHEAD = 0.02


@pytest.fixture(scope="module")
def model(human: RobotDescription) -> mujoco.MjModel:
    return human.spec().compile()


@pytest.fixture
def state(human: RobotDescription) -> RobotState:
    return state_of(human)


def moving(model: mujoco.MjModel, seed: int) -> mujoco.MjData:
    """Return the human in any pose, anywhere, with everything moving."""
    rng = np.random.default_rng(seed)
    data = mujoco.MjData(model)
    data.qpos[:] = rng.normal(0.0, 0.4, model.nq)
    data.qpos[3:7] /= np.linalg.norm(data.qpos[3:7])
    data.qvel[:] = rng.normal(0.0, 2.0, model.nv)
    mujoco.mj_forward(model, data)
    return data


def observed(data: mujoco.MjData) -> Observation:
    zero = np.zeros(len(data.qvel) - 6)
    joints = JointState(data.qpos[7:].copy(), data.qvel[6:].copy(), zero, zero, zero, zero)
    base = BaseState(
        data.qpos[:3].copy(), data.qpos[3:7].copy(), data.qvel[:3].copy(), data.qvel[3:6].copy()
    )
    return Observation(0.0, joints, None, np.zeros(10), base)


@pytest.mark.parametrize("seed", range(4))
def test_com_feet_and_torso_are_mujocos(
    human: RobotDescription, model: mujoco.MjModel, state: RobotState, seed: int
) -> None:
    data = moving(model, seed)
    state.update(observed(data))
    com = np.average(data.xipos, axis=0, weights=model.body_mass)
    np.testing.assert_allclose(state.com, com, atol=1e-12)
    for foot, pose in zip(human.feet, state.feet, strict=True):
        np.testing.assert_allclose(pose.position, data.site(foot.site).xpos, atol=1e-12)
        np.testing.assert_allclose(pose.rotation.ravel(), data.site(foot.site).xmat, atol=1e-12)
    np.testing.assert_allclose(state.up, data.body(human.torso).xmat[2::3], atol=1e-12)
    np.testing.assert_allclose(state.pose.rotation.ravel(), data.body(human.base).xmat, atol=1e-12)
    assert state.mass == pytest.approx(model.body_mass.sum())


@pytest.mark.parametrize("seed", range(4))
def test_com_velocity_is_how_fast_the_com_moves(
    model: mujoco.MjModel, state: RobotState, seed: int
) -> None:
    data = moving(model, seed)
    velocity = state.update(observed(data)).com_velocity
    dt, at = 1e-5, []
    for sign in (-1.0, 1.0):
        near = moving(model, seed)
        mujoco.mj_integratePos(model, near.qpos, near.qvel, sign * dt)
        at.append(state.update(observed(near)).com)
    np.testing.assert_allclose(velocity, (at[1] - at[0]) / (2.0 * dt), atol=1e-6)


def test_linear_momentum_is_the_sum_over_the_bodies(
    model: mujoco.MjModel, state: RobotState
) -> None:
    data = moving(model, 7)
    momentum = np.zeros(3)
    for index in range(1, model.nbody):
        speed = np.zeros(6)
        mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, index, speed, 0)
        momentum += model.body_mass[index] * speed[3:]
    found = state.update(observed(data))
    np.testing.assert_allclose(found.mass * found.com_velocity, momentum, atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_momenta_are_mujocos(model: mujoco.MjModel, state: RobotState, seed: int) -> None:
    data = moving(model, seed)
    momenta = state.update(observed(data)).momenta
    matrix = np.zeros((3, model.nv))
    mujoco.mj_angmomMat(model, data, matrix, 1)
    np.testing.assert_allclose(momenta.angular, matrix @ data.qvel, atol=1e-9)
    np.testing.assert_allclose(momenta.com, data.subtree_com[1], atol=1e-12)
    assert momenta.linear == pytest.approx(momenta.mass * momenta.velocity)


def test_jacobians_give_the_velocities(model: mujoco.MjModel, state: RobotState) -> None:
    data = moving(model, 5)
    found = state.update(observed(data))
    np.testing.assert_allclose(found.velocity, data.qvel)
    np.testing.assert_allclose(found.com_jacobian @ data.qvel, found.com_velocity, atol=1e-9)
    twist = np.zeros(6)
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_SITE, int(found.sites[1]), twist, 0)
    np.testing.assert_allclose(found.jacobian(1) @ data.qvel, twist[[3, 4, 5, 0, 1, 2]], atol=1e-9)


def test_support_is_the_hull_of_the_soles_points(model: mujoco.MjModel, state: RobotState) -> None:
    found = state.update(observed(moving(model, 3)))
    both = found.support((0, 1)).shape
    assert both.equals(MultiPoint(found.ground[:, :2]).convex_hull)
    for foot in (0, 1):
        one = found.support((foot,)).shape
        assert one.area < both.area
        assert both.covers(one)


def test_positions_are_extrapolated_and_velocities_are_not(
    human: RobotDescription, model: mujoco.MjModel, state: RobotState
) -> None:
    data = moving(model, 2)
    ahead = state_of(human, AHEAD).update(observed(data))
    later = moving(model, 2)
    mujoco.mj_integratePos(model, later.qpos, later.qvel, AHEAD)
    then = state.update(observed(later))
    np.testing.assert_allclose(ahead.com, then.com, atol=1e-12)
    np.testing.assert_allclose(ahead.pose.rotation, then.pose.rotation, atol=1e-12)
    np.testing.assert_array_equal(ahead.joint_position, later.qpos[7:])
    np.testing.assert_array_equal(ahead.velocity, data.qvel)


def test_the_same_observation_is_computed_once(
    model: mujoco.MjModel, state: RobotState, monkeypatch: pytest.MonkeyPatch
) -> None:
    _ = state.soles  # made once, from the model
    calls: list[int] = []
    real = mujoco.mj_kinematics

    def counted(*args: Any) -> None:
        calls.append(1)
        real(*args)

    monkeypatch.setattr(mujoco, "mj_kinematics", counted)
    seen = observed(moving(model, 1))
    assert not calls
    for _ in range(3):
        found = state.update(seen)
        assert found.momenta is found.momenta
        assert found.support((0, 1)) is found.support((0, 1))
        assert found.jacobian(0) is found.jacobian(0)
        assert found.outcomes.com.shape == (1, 3)
    assert len(calls) == 1


def test_nothing_is_computed_that_nobody_asks_for(model: mujoco.MjModel, state: RobotState) -> None:
    state.update(observed(moving(model, 1)))
    assert not state.__dict__.keys() & set(PER_OBSERVATION)
    _ = state.feet
    assert not state.__dict__.keys() & {"velocity_stage", "momenta", "com_jacobian", "ground"}


def test_another_base_in_the_same_tick_leaves_nothing_of_the_old_one(
    model: mujoco.MjModel, state: RobotState
) -> None:
    data = moving(model, 1)
    believed = observed(data)
    old = {name: getattr(state.update(believed), name) for name in PER_OBSERVATION}
    assert believed.base is not None
    base = replace(believed.base, position=believed.base.position + np.array([1.0, 0.0, 0.0]))
    com, feet = state.com.copy(), state.feet_position.copy()
    found = state.update(replace(believed, base=base))
    np.testing.assert_allclose(found.com - com, [1.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_array_equal(old["com"], com)
    np.testing.assert_array_equal(old["feet_position"], feet)
    assert found.outcomes is not old["outcomes"]


def test_without_a_base_nothing_can_be_said(model: mujoco.MjModel, state: RobotState) -> None:
    with pytest.raises(StateMissingError, match="no observation has been taken yet"):
        _ = state.com
    with pytest.raises(StateMissingError) as error:
        _ = state.update(replace(observed(moving(model, 0)), base=None)).com
    assert str(error.value) == "the base state is missing; run with `--state estimated`"
