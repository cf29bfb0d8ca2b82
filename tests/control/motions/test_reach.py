from dataclasses import replace

import numpy as np
import pytest

from tests.small_world import CONTACTS, JOINTS, L_TOE, R_HEEL, N, observation
from windup.control.motions.reach import Condition, lean
from windup.control.pose_graph.gait_file import Reach
from windup.hal.errors import StateMissingError
from windup.hal.joints import Array
from windup.hal.observation import BaseState, Observation

GOAL = np.full(N, 0.5)
Y, X = [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]


def tilted(axis: list[float], degrees: float, contacts: Array = L_TOE) -> Observation:
    half = np.radians(degrees) / 2.0
    turned = np.array([np.cos(half), *(np.sin(half) * np.array(axis))])
    base = BaseState(np.zeros(3), turned, np.zeros(3), np.zeros(3))
    return observation(position=GOAL, contacts=contacts, base=base)


def unmet(reach: Reach, seen: Observation) -> str | None:
    return Condition(reach, JOINTS, CONTACTS).unmet(seen, GOAL)


@pytest.mark.parametrize("angle", [-170.0, -90.0, -20.0, 0.0, 45.0, 90.0, 135.0])
def test_the_lean_forward_goes_all_the_way_round(angle: float) -> None:
    assert lean(tilted(Y, angle)) == pytest.approx((angle, 0.0), abs=1e-6)


def test_a_lean_to_the_right_is_positive() -> None:
    assert lean(tilted(X, 30.0)) == pytest.approx((0.0, 30.0), abs=1e-6)


def test_without_an_attitude_nobody_can_tell() -> None:
    with pytest.raises(StateMissingError, match=r"base's attitude, which nobody measures"):
        unmet(Reach(side=5.0), observation())


@pytest.mark.parametrize(
    ("reach", "seen", "message"),
    [
        (
            Reach(lean=(-5, 10)),
            tilted(Y, 12),
            "leans 12 degrees forward (-5 .. 10 is fine",
        ),
        (Reach(side=5), tilted(X, -6), "leans 6 degrees to the left (5 is fine)"),
        (Reach(feet=True), tilted(Y, 0), "right_foot is not on the ground"),
    ],
    ids=["forward", "side", "feet"],
)
def test_what_is_not_true_is_said(reach: Reach, seen: Observation, message: str) -> None:
    assert message in (unmet(reach, seen) or "")


def test_what_is_true_is_said_to_be() -> None:
    reach = Reach(joints=1, still=1, lean=(-5, 10), side=5, feet=True)
    assert unmet(reach, tilted(Y, 8, contacts=L_TOE + R_HEEL)) is None


def test_the_farthest_and_the_fastest_joint_are_named() -> None:
    seen = tilted(Y, 0)
    far = replace(seen.joints, position=GOAL + np.radians([0, 1, -9, 2, 0]))
    fast = replace(seen.joints, velocity=np.radians([0, 0, 0, 0, 30.0]))
    assert unmet(Reach(joints=5), replace(seen, joints=far)) == (
        "l_knee is 9.0 degrees from its goal (5 is fine)"
    )
    assert unmet(Reach(still=20), replace(seen, joints=fast)) == (
        "r_knee is 30.0 degrees/s fast (20 is fine)"
    )
