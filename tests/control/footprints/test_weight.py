import mujoco
import numpy as np
import pytest

from windup.control.footprints.weight import holding_torque
from windup.robots import RobotDescription
from windup.tools.assembly.build import body_of


def test_torques_that_hold_the_weight_do_the_work_that_lifts_it(op3: RobotDescription) -> None:
    body, shares = body_of(op3), (0.3, 0.7)
    model, data = body.model, body.data
    base = model.body(op3.base).id
    data.qpos[:7] = [0.0, 0.0, 0.3, 1.0, 0.0, 0.0, 0.0]

    def height(joints: np.ndarray) -> float:
        """Of the centre of mass above where the ground bears it."""
        data.qpos[7:] = joints
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        soles = data.site_xpos[body.soles, 2]
        return float(data.subtree_com[base, 2] - np.dot(shares, soles))

    pose = op3.poses["bent_knees"]
    steps = 1e-5 * np.eye(len(pose))
    work = [(height(pose + step) - height(pose - step)) / 2e-5 for step in steps]
    height(pose)
    torque = holding_torque(body, op3.base, shares)
    assert torque == pytest.approx(body.mass * 9.81 * np.array(work), abs=1e-5)
    assert np.abs(torque).max() > 0.5
