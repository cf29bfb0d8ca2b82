"""Which step brings the feet back; `test_torque_stepper` has the human take it."""

import numpy as np
import pytest

from windup.control.footprints.footprints import Footprint
from windup.control.stepping.torque_comfort import ComfortWalk, TorqueComfort
from windup.hal.joints import Array

STANCE = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]])


def never(missing: Footprint) -> ComfortWalk:
    raise AssertionError("nothing is walked here")


def anywhere(foot: int, yaw: float, start: Array, target: Array) -> bool:
    return True


@pytest.fixture
def comfort() -> TorqueComfort:
    made = TorqueComfort(never, 0.03)
    made.reset(STANCE)
    return made


def test_feet_in_their_stance_stay(comfort: TorqueComfort) -> None:
    assert comfort.needed(STANCE, anywhere) is None
    assert comfort.needed(STANCE + np.array([0.5, 0.2, 0.0]), anywhere) is None


@pytest.mark.parametrize(("behind", "foot"), [(np.array([0.2, 0.0]), 1), (np.array([0, 0.2]), 0)])
def test_the_foot_behind_comes_forward(comfort: TorqueComfort, behind: Array, foot: int) -> None:
    places = STANCE.copy()
    places[:, 0] += behind
    missing = comfort.needed(places, anywhere)
    assert missing is not None
    assert missing.foot == foot
    assert missing.place == pytest.approx([0.0, 0.2 if foot == 0 else -0.2, 0.0])


def test_a_turned_foot_is_turned_back(comfort: TorqueComfort) -> None:
    places = STANCE.copy()
    places[1, 2] = 0.3
    assert comfort.needed(places, anywhere) is not None


def test_nothing_goes_where_it_must_not(comfort: TorqueComfort) -> None:
    places = STANCE + np.array([[0.3, 0.0, 0.0], [0.0, 0.0, 0.0]])
    assert comfort.needed(places, lambda *_: False) is None
