import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.small_world import AIR, JOINTS, N, policy_state
from windup.control.pose_graph.gait_file import TorsoServo as Record
from windup.control.pose_graph.torso_servo import TorsoServo
from windup.hal.command import JointCommand, joint_torque
from windup.hal.errors import UnknownNameError
from windup.robots import RobotDescription

SERVO = TorsoServo.of(Record(joint="waist", angle=5.0), JOINTS)
FREE = np.full(N, np.inf)


@given(
    pitch=st.floats(-1.0, 1.0),
    rate=st.floats(-3.0, 3.0),
    q=st.floats(-1.0, 1.0),
    dq=st.floats(-3.0, 3.0),
)
def test_the_waist_feels_the_thesis_pd_law_on_the_torsos_lean(
    pitch: float, rate: float, q: float, dq: float
) -> None:
    goals = SERVO.apply(np.zeros((1, N)), policy_state([AIR], pitch, rate))[0]
    position, velocity = np.full(N, q), np.full(N, dq)
    torque = joint_torque(JointCommand.hold(JOINTS, goals), position, velocity, FREE)
    kp, kd = JOINTS.stiffness[0], JOINTS.damping[0]
    lean, lean_rate = pitch + q, rate + dq
    wanted = kp * (np.radians(5.0) - lean) - kd * lean_rate
    assert torque[0] == pytest.approx(wanted, abs=1e-9)


def test_it_moves_its_own_joint_only_and_leaves_the_pose_alone() -> None:
    pose = np.full((2, N), 0.3)
    goals = SERVO.apply(pose, policy_state([AIR, AIR], 0.2, 0.1))
    np.testing.assert_array_equal(goals[:, 1:], 0.3)
    np.testing.assert_array_equal(pose, 0.3)


@pytest.mark.parametrize("yaw", [0.0, 1.0, -2.5, 3.1])
@pytest.mark.parametrize("pitch", [-0.4, 0.0, 0.3])
@pytest.mark.parametrize("roll", [0.0, 0.2])
def test_the_humans_torso_leans_as_asked_whatever_way_it_faces(
    human: RobotDescription, yaw: float, pitch: float, roll: float
) -> None:
    servo = TorsoServo.of(Record(joint="waist", angle=5.0), human.joints)
    state = policy_state([AIR])
    state.base_orientation = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_quat(
        scalar_first=True
    )[None]
    model = human.spec().compile()
    data = mujoco.MjData(model)
    data.qpos[3:7] = state.base_orientation[0]
    data.qpos[7:] = servo.apply(np.zeros((1, len(human.joints))), state)[0]
    mujoco.mj_kinematics(model, data)
    # Lean about the pelvis' own y axis, from the plumb line seen along it.
    forward, _, up = data.body(human.torso).xmat.reshape(3, 3)[2]
    assert np.degrees(np.arctan2(-forward, up)) == pytest.approx(5.0, abs=1e-9)


def test_a_joint_that_is_not_there_is_named() -> None:
    with pytest.raises(UnknownNameError, match="unknown joint 'wasit'; did you mean 'waist'"):
        TorsoServo.of(Record(joint="wasit"), JOINTS)
