"""Goals that servos can follow."""

import numpy as np
import pytest

from windup.control.pose_graph.goal_limits import GoalLimits
from windup.hal.joints import Joint, Joints


def joints(speed: float) -> Joints:
    return Joints((Joint("a", -1.0, 1.0, 1.0, 0.1, goal_speed=speed),))


def test_a_goal_that_jumps_runs_there_at_the_servos_speed() -> None:
    limits = GoalLimits(joints(5.0))
    sent = np.array([0.0])
    way = []
    for _ in range(4):
        sent = limits.apply(np.array([0.1]), sent, 0.008)
        way.append(float(sent[0]))
    assert way == pytest.approx([0.04, 0.08, 0.1, 0.1])


def test_rollouts_each_have_their_own_way() -> None:
    before = np.array([[0.0], [0.5]])
    goals = GoalLimits(joints(5.0)).apply(np.array([[-1.0], [1.0]]), before, 0.01)
    assert goals.ravel() == pytest.approx([-0.05, 0.55])


@pytest.mark.parametrize(("speed", "before"), [(np.inf, np.zeros(1)), (5.0, None)])
def test_without_such_a_limit_or_a_goal_before_only_the_joint_limits_count(
    speed: float, before: np.ndarray | None
) -> None:
    assert GoalLimits(joints(speed)).apply(np.array([3.0]), before, 0.01) == pytest.approx([1.0])
