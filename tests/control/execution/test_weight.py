import numpy as np
import pytest

from windup.control.execution.weight import holding_torque
from windup.hal.observation import BaseState, JointState, Observation
from windup.robots import RobotDescription
from windup.tools.assembly.state import state_of


def standing(joints: np.ndarray) -> Observation:
    still, zero = np.zeros(len(joints)), np.zeros(3)
    base = BaseState(np.array([0.0, 0.0, 0.3]), np.eye(4)[0], zero, zero)
    seen = JointState(joints, still, still, still, still, still)
    return Observation(0.0, seen, None, np.zeros(0), base)


def test_torques_that_hold_the_weight_do_the_work_that_lifts_it(op3: RobotDescription) -> None:
    state, shares = state_of(op3), (0.3, 0.7)

    def height(joints: np.ndarray) -> float:
        """Of the centre of mass above where the ground bears it."""
        state.update(standing(joints))
        return float(state.com[2] - np.dot(shares, state.feet_position[:, 2]))

    pose = op3.poses["bent_knees"]
    steps = 1e-5 * np.eye(len(pose))
    work = [(height(pose + step) - height(pose - step)) / 2e-5 for step in steps]
    height(pose)
    torque = holding_torque(state, shares)
    assert torque == pytest.approx(state.mass * 9.81 * np.array(work), abs=1e-5)
    assert np.abs(torque).max() > 0.5
