import numpy as np
import pytest

from tests.small_world import JOINTS, N
from windup.hal.command import FIELDS, JointCommand, joint_torque, shifted_goal
from windup.hal.errors import UnsafeCommandError


def command(**rows: float) -> JointCommand:
    block = np.zeros((len(FIELDS), N))
    for name, value in rows.items():
        block[FIELDS.index(name)] = value
    return JointCommand(block)


def test_torque_is_stiffness_times_error_plus_damping_times_slip_plus_feed_forward() -> None:
    asked = command(position=0.5, velocity=2.0, torque=0.25, stiffness=4.0, damping=0.5)
    torque = joint_torque(asked, np.full(N, 0.25), np.full(N, 1.0), JOINTS.torque)
    np.testing.assert_allclose(torque, 4.0 * 0.25 + 0.5 * 1.0 + 0.25)


def test_torque_stays_within_the_joints_limits_on_both_sides() -> None:
    zero = np.zeros(N)
    up = joint_torque(command(position=1.0, stiffness=100.0), zero, zero, JOINTS.torque)
    down = joint_torque(command(position=-1.0, stiffness=100.0), zero, zero, JOINTS.torque)
    np.testing.assert_array_equal(up, JOINTS.torque)
    np.testing.assert_array_equal(down, -JOINTS.torque)


def test_the_rows_of_a_command_are_views_of_its_block() -> None:
    asked = JointCommand(np.repeat(np.arange(float(len(FIELDS)))[:, None], N, axis=1))
    for row, name in enumerate(FIELDS):
        np.testing.assert_array_equal(getattr(asked, name), np.full(N, row))


def test_hold_has_the_robots_gains_and_no_feed_forward() -> None:
    asked = JointCommand.hold(JOINTS, np.full(N, 0.3))
    np.testing.assert_array_equal(asked.position, np.full(N, 0.3))
    np.testing.assert_array_equal(asked.stiffness, JOINTS.stiffness)
    np.testing.assert_array_equal(asked.damping, JOINTS.damping)
    assert not asked.velocity.any()
    assert not asked.torque.any()


def test_a_command_has_what_it_is_made_of_and_cannot_be_changed() -> None:
    asked = JointCommand.of(JOINTS, position=0.1, velocity=0.2, torque=np.full(N, 0.3), damping=0.5)
    for name, value in (("position", 0.1), ("velocity", 0.2), ("torque", 0.3), ("damping", 0.5)):
        np.testing.assert_array_equal(getattr(asked, name), np.full(N, value))
    np.testing.assert_array_equal(asked.stiffness, JOINTS.stiffness)
    with pytest.raises(ValueError, match="read-only"):
        asked.position[0] = 1.0


def test_the_same_command_at_another_position_leaves_the_first_alone() -> None:
    first = JointCommand.of(JOINTS, position=0.1, torque=0.3)
    other = first.with_position(np.full(N, 0.7))
    np.testing.assert_array_equal(other.position, np.full(N, 0.7))
    np.testing.assert_array_equal(other.block[1:], first.block[1:])
    np.testing.assert_array_equal(first.position, np.full(N, 0.1))


def test_a_shifted_goal_gives_a_position_servo_the_feed_forward_terms() -> None:
    asked = command(position=0.1, velocity=1.0, torque=0.6, stiffness=4.0, damping=0.2)
    np.testing.assert_allclose(shifted_goal(asked), 0.1 + (0.2 * 1.0 + 0.6) / 4.0)
    q, dq = np.full(N, 0.05), np.full(N, 0.7)
    whole = joint_torque(asked, q, dq, np.full(N, np.inf))
    servo = 4.0 * (shifted_goal(asked) - q) - 0.2 * dq
    np.testing.assert_allclose(servo, whole)


def test_a_shifted_goal_counts_on_the_stiffness_that_is_there() -> None:
    asked = command(position=0.1, torque=0.6, stiffness=4.0)
    np.testing.assert_allclose(shifted_goal(asked, np.full(N, 2.0)), 0.1 + 0.6 / 2.0)


def test_a_joint_without_stiffness_keeps_its_goal() -> None:
    asked = command(position=0.1, velocity=1.0, torque=0.6, damping=0.2)
    np.testing.assert_array_equal(shifted_goal(asked), np.full(N, 0.1))


def test_a_row_of_another_shape_is_named() -> None:
    with pytest.raises(UnsafeCommandError) as error:
        JointCommand.of(JOINTS, position=0.0, torque=np.zeros(N + 1))
    assert str(error.value) == (
        f"torque: a command of shape {(N + 1,)} for {N} joints; its shape has to be {(N,)}"
    )
