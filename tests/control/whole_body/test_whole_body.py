from dataclasses import replace

import numpy as np
import pytest

from windup.control.whole_body.dynamics import Dynamics
from windup.control.whole_body.whole_body import FASTEST, Objectives, WholeBody
from windup.control.whole_body.whole_body_file import Weights
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.observation import BaseState, JointState, Observation
from windup.robots import load_robot
from windup.tools.assembly.state import state_of

HUMAN = load_robot("human")
STANCE = HUMAN.poses["ready"]


def seen() -> Observation:
    zeros = np.zeros(len(STANCE))
    joints = JointState(STANCE.copy(), zeros, zeros, zeros, zeros, zeros)
    base = BaseState(np.array([0.0, 0.0, 1.0]), np.eye(4)[0], np.zeros(3), np.zeros(3))
    return Observation(0.0, joints, None, np.zeros(len(HUMAN.contacts.names)), base)


@pytest.fixture
def dynamics() -> Dynamics:
    dynamics = Dynamics(state_of(HUMAN))
    dynamics.update(seen())
    return dynamics


def standing(dynamics: Dynamics, com: tuple[float, float, float]) -> Objectives:
    still = np.zeros(6)
    zeros = np.zeros(len(STANCE))
    return Objectives(np.array(com), np.zeros(3), zeros, np.zeros(3), (0, 1), (still, still))


def body(dynamics: Dynamics, torque: float = 1e3) -> WholeBody:
    return WholeBody(dynamics, np.full(len(STANCE), torque), 0.8)


def test_a_foot_has_four_corners_on_one_level(dynamics: Dynamics) -> None:
    for foot in (0, 1):
        assert dynamics.corners[foot].shape == (4, 3)
        assert np.ptp(dynamics.ground(foot)[:, 2]) < 1e-6


def test_standing_carries_the_weight_and_accelerates_nothing(dynamics: Dynamics) -> None:
    plan = body(dynamics).plan(standing(dynamics, (0.0, 0.0, 0.0)))
    force = sum(forces.sum(axis=0) for forces in plan.forces.values())
    assert force == pytest.approx([0.0, 0.0, dynamics.momenta.mass * GRAVITY], abs=2.0)
    assert np.abs(plan.acceleration).max() < 0.5


def test_torques_and_forces_obey_the_equation_of_motion(dynamics: Dynamics) -> None:
    whole = body(dynamics)
    plan = whole.plan(standing(dynamics, (0.5, 0.3, 0.2)))
    residual = dynamics.mass @ plan.acceleration + dynamics.bias
    residual[6:] -= whole.torque(plan)
    for foot, forces in plan.forces.items():
        arms = dynamics.ground(foot) - dynamics.ends[foot].position
        wrench = np.concatenate((forces.sum(axis=0), np.cross(arms, forces).sum(axis=0)))
        residual -= dynamics.jacobian(foot).T @ wrench
    assert np.abs(residual).max() < 1e-3


def test_the_centre_of_mass_accelerates_as_asked(dynamics: Dynamics) -> None:
    alone = Weights(posture=0.0, trunk=0.0)  # with them it is a compromise
    limit = np.full(len(STANCE), 1e3)
    plan = WholeBody(dynamics, limit, 0.8, alone).plan(standing(dynamics, (0.3, 0.2, 0.4)))
    force = sum(forces.sum(axis=0) for forces in plan.forces.values())
    rate = force / dynamics.momenta.mass - np.array([0.0, 0.0, GRAVITY])
    assert rate == pytest.approx([0.3, 0.2, 0.4], abs=0.05)


def test_forces_stay_inside_friction_whatever_is_asked(dynamics: Dynamics) -> None:
    plan = body(dynamics).plan(standing(dynamics, (30.0, 0.0, 0.0)))
    for forces in plan.forces.values():
        assert (forces[:, 2] > -1e-6).all()
        assert (np.abs(forces[:, :2]).sum(axis=1) <= 0.8 * forces[:, 2] + 1e-6).all()


def test_torque_limits_hold(dynamics: Dynamics) -> None:
    whole = body(dynamics, torque=60.0)
    wanted = replace(standing(dynamics, (0.0, 0.0, 8.0)), angular=np.array([0.0, 50.0, 0.0]))
    assert np.abs(whole.torque(whole.plan(wanted))).max() <= 60.0


def test_the_answer_is_the_same_again(dynamics: Dynamics) -> None:
    first, again = (body(dynamics).plan(standing(dynamics, (1.0, 0.0, 0.0))) for _ in range(2))
    assert first.acceleration.tobytes() == again.acceleration.tobytes()


def test_no_plan_asks_for_more_than_a_body_can_do(dynamics: Dynamics) -> None:
    wanted = replace(standing(dynamics, (0.0, 0.0, 0.0)), posture=np.full(len(STANCE), 1e6))
    plan = body(dynamics).plan(wanted)
    assert np.abs(plan.acceleration).max() < 1.01 * FASTEST
