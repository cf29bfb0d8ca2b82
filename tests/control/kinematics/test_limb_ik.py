import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from windup.control.kinematics.limb_ik import LimbIk, Pose
from windup.control.kinematics.rotation import turn_between
from windup.hal.errors import UsageError
from windup.robots import load_robot

OP3 = load_robot("op3")
MODEL = OP3.spec().compile()
LEFT = LimbIk(MODEL, OP3.base, OP3.feet[0].site)
CROUCHED = OP3.poses["bent_knees"]


@settings(max_examples=30, deadline=None)
@given(st.lists(st.floats(-0.04, 0.04), min_size=3, max_size=3), st.floats(-0.3, 0.3))
def test_the_sole_comes_where_it_should(move: list[float], yaw: float) -> None:
    home = LEFT.forward(CROUCHED)
    turn = np.empty(9)
    mujoco.mju_axisAngle2Quat(quat := np.empty(4), np.array([0.0, 0.0, 1.0]), yaw)
    mujoco.mju_quat2Mat(turn, quat)
    target = Pose(
        home.position + np.array([*move[:2], abs(move[2])]), turn.reshape(3, 3) @ home.rotation
    )
    pose = CROUCHED.copy()
    pose[LEFT.joints] = LEFT.solve(target, pose, steps=20)
    reached = LEFT.forward(pose)
    assert reached.position == pytest.approx(target.position, abs=1e-3)
    assert np.abs(turn_between(reached.rotation, target.rotation)).max() < 2e-3


def test_what_is_out_of_reach_stays_within_the_joints_limits() -> None:
    home = LEFT.forward(CROUCHED)
    far = LEFT.solve(
        Pose(home.position + np.array([0.5, 0.3, 0.4]), home.rotation), CROUCHED, steps=50
    )
    lower, upper = MODEL.jnt_range[1 + LEFT.joints].T
    assert np.all((far >= lower) & (far <= upper))


def test_out_of_reach_the_limb_comes_to_rest() -> None:
    home, pose = LEFT.forward(CROUCHED), CROUCHED.copy()
    target = Pose(home.position + np.array([-0.2, 0.0, 0.0]), home.rotation)
    for _ in range(60):
        before = pose[LEFT.joints].copy()
        pose[LEFT.joints] = LEFT.solve(target, pose, steps=1)
    assert np.abs(pose[LEFT.joints] - before).max() < 1e-2


def test_only_the_joints_of_the_limb_belong_to_it() -> None:
    names = [OP3.joints.names[k] for k in LEFT.joints]
    assert len(names) == 6
    assert all(name.startswith("l_") for name in names)


def test_an_end_on_the_base_is_no_limb() -> None:
    assert OP3.imu is not None
    with pytest.raises(UsageError, match="no joint lies between"):
        LimbIk(MODEL, OP3.base, OP3.imu.site)
