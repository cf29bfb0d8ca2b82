from dataclasses import replace

import mujoco
import numpy as np
import pytest

from windup.control.kinematics.body import Body
from windup.hal.errors import StateMissingError
from windup.hal.observation import BaseState, JointState, Observation
from windup.robots import RobotDescription


@pytest.fixture(scope="module")
def model(human: RobotDescription) -> mujoco.MjModel:
    return human.spec().compile()


@pytest.fixture(scope="module")
def body(human: RobotDescription, model: mujoco.MjModel) -> Body:
    return Body(model, human.base, human.torso, [foot.site for foot in human.feet])


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
    human: RobotDescription, model: mujoco.MjModel, body: Body, seed: int
) -> None:
    data = moving(model, seed)
    found = body.measure(observed(data))
    com = np.average(data.xipos, axis=0, weights=model.body_mass)
    np.testing.assert_allclose(found.com[0], com, atol=1e-12)
    feet = [data.site(foot.site).xpos for foot in human.feet]
    np.testing.assert_allclose(found.feet[0], feet, atol=1e-12)
    np.testing.assert_allclose(found.torso[0], data.body(human.torso).xmat[2::3], atol=1e-12)
    assert body.mass == pytest.approx(model.body_mass.sum())


@pytest.mark.parametrize("seed", range(4))
def test_com_velocity_is_how_fast_the_com_moves(
    model: mujoco.MjModel, body: Body, seed: int
) -> None:
    data = moving(model, seed)
    velocity = body.measure(observed(data)).com_velocity[0]
    dt, at = 1e-5, []
    for sign in (-1.0, 1.0):
        near = moving(model, seed)
        mujoco.mj_integratePos(model, near.qpos, near.qvel, sign * dt)
        at.append(body.measure(observed(near)).com[0])
    np.testing.assert_allclose(velocity, (at[1] - at[0]) / (2.0 * dt), atol=1e-6)


def test_linear_momentum_is_the_sum_over_the_bodies(model: mujoco.MjModel, body: Body) -> None:
    data = moving(model, 7)
    found = body.measure(observed(data))
    momentum = np.zeros(3)
    for index in range(1, model.nbody):
        speed = np.zeros(6)
        mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, index, speed, 0)
        momentum += model.body_mass[index] * speed[3:]
    np.testing.assert_allclose(body.mass * found.com_velocity[0], momentum, atol=1e-9)


def test_a_measurement_stays_when_the_next_is_made(model: mujoco.MjModel, body: Body) -> None:
    first = body.measure(observed(moving(model, 1)))
    com, feet = first.com.copy(), first.feet.copy()
    body.measure(observed(moving(model, 2)))
    np.testing.assert_array_equal(first.com, com)
    np.testing.assert_array_equal(first.feet, feet)


def test_without_a_base_nothing_can_be_said(model: mujoco.MjModel, body: Body) -> None:
    with pytest.raises(StateMissingError) as error:
        body.measure(replace(observed(moving(model, 0)), base=None))
    assert str(error.value) == "the base state is missing; run with `--state estimated`"


@pytest.mark.parametrize("seed", range(4))
def test_momenta_are_mujocos(model: mujoco.MjModel, body: Body, seed: int) -> None:
    data = moving(model, seed)
    body.measure(observed(data))
    momenta = body.momenta()
    matrix = np.zeros((3, model.nv))
    mujoco.mj_angmomMat(model, data, matrix, 1)
    np.testing.assert_allclose(momenta.angular, matrix @ data.qvel, atol=1e-9)
    np.testing.assert_allclose(momenta.com, data.subtree_com[1], atol=1e-12)
    assert momenta.linear == pytest.approx(momenta.mass * momenta.velocity)
