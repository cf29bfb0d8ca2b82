"""Which falls cannot be prevented."""

from dataclasses import replace
from math import atan2, cos, pi, radians, sin

import numpy as np
import pytest

from tests.control.biped import observed, robot_state
from windup.control.falling.fall import FallPredictor, unreachable
from windup.control.kinematics.momenta import Momenta
from windup.hal.errors import StateMissingError
from windup.hal.observation import BaseState, Observation

SOLES = np.array([[0.05, 0.05], [0.05, -0.05], [-0.05, 0.05], [-0.05, -0.05]])
REACH = 0.1


def moving(x: float, y: float, speed: tuple[float, float] = (0.0, 0.0)) -> Momenta:
    """Return a body of omega 5 1/s over (x, y)."""
    com = np.array([x, y, 9.81 / 25.0])
    return Momenta(3.0, com, np.array([*speed, 0.0]), np.zeros(3))


def test_what_a_step_catches_is_no_fall() -> None:
    assert unreachable(moving(0.14, 0.0), SOLES, REACH) is None
    assert unreachable(moving(0.0, 0.0, (0.7, 0.0)), SOLES, REACH) is None


def test_tilt_and_speed_add_up_to_a_fall() -> None:
    assert unreachable(moving(0.1, 0.0), SOLES, REACH) is None
    assert unreachable(moving(0.0, 0.0, (0.5, 0.0)), SOLES, REACH) is None
    way = unreachable(moving(0.1, 0.0, (0.5, 0.0)), SOLES, REACH)
    assert way == pytest.approx([0.2, 0.0])


def test_reach_counts_from_the_hull_and_not_from_its_corners() -> None:
    assert unreachable(moving(0.149, 0.0), SOLES, REACH) is None
    assert unreachable(moving(0.151, 0.0), SOLES, REACH) is not None


def predictor() -> FallPredictor:
    return FallPredictor(robot_state(), REACH)


def tipping(time: float, toward: float, tilt: float, yaw: float = 0.0) -> Observation:
    """Return what a biped says that leans by `tilt` rad toward `toward` rad of its own front."""
    axis = np.array([-sin(toward), cos(toward), 0.0])
    lean = np.array([cos(0.5 * tilt), *(sin(0.5 * tilt) * axis)])
    w, x, y, z = lean
    c, s = cos(0.5 * yaw), sin(0.5 * yaw)
    orientation = np.array([c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w])
    base = BaseState(np.array([0.0, 0.0, 0.25]), orientation, np.zeros(3), np.zeros(3))
    return replace(observed(time), base=base)


@pytest.mark.parametrize("toward", [0.0, 90.0, 180.0, -90.0])
@pytest.mark.parametrize("yaw", [0.0, 2.0])
def test_it_says_to_which_side_whatever_the_heading(toward: float, yaw: float) -> None:
    watch = predictor()
    for tick in range(3):
        watch.update(tipping(0.004 * tick, radians(toward), 1.2, yaw))
    assert watch.toward is not None
    off = watch.toward - radians(toward)
    assert abs(atan2(sin(off), cos(off))) < pi / 6


def test_one_sample_of_noise_is_no_fall_and_a_fall_is_not_taken_back() -> None:
    watch = predictor()
    assert not watch.update(tipping(0.0, 0.0, 1.2))
    assert not watch.update(tipping(0.004, 0.0, 0.0))
    assert not watch.update(tipping(0.008, 0.0, 1.2))
    assert watch.update(tipping(0.016, 0.0, 1.2))
    assert watch.update(tipping(0.020, 0.0, 0.0))
    watch.reset()
    assert not watch.update(tipping(0.024, 0.0, 0.0))


def test_without_a_base_it_says_what_to_do() -> None:
    with pytest.raises(StateMissingError, match="--no-protect"):
        predictor().update(observed(0.0))
