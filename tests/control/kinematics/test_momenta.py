import numpy as np
import pytest

from windup.control.kinematics.momenta import (
    Momenta,
    capture_point,
    centre_of_pressure,
    desired_cp,
)
from windup.hal.geometry.gravity import GRAVITY

STILL = Momenta(3.0, np.array([0.1, -0.2, 0.25]), np.zeros(3), np.zeros(3))


def moving(velocity: tuple[float, float, float], angular: tuple[float, float, float]) -> Momenta:
    return Momenta(3.0, STILL.com, np.array(velocity), np.array(angular))


def test_a_body_at_rest_is_pushed_from_right_below() -> None:
    assert centre_of_pressure(STILL, np.zeros(3), np.zeros(3)) == pytest.approx([0.1, -0.2])
    assert desired_cp(STILL, 4.0, 6.0) == pytest.approx([0.1, -0.2])
    assert capture_point(STILL) == pytest.approx([0.1, -0.2])


def test_the_force_points_from_the_centre_of_pressure_to_the_centre_of_mass() -> None:
    force = np.array([2.0, -1.0, 5.0])
    at = centre_of_pressure(STILL, force, np.zeros(3))
    arm = STILL.com - [*at, 0.0]
    push = force + np.array([0.0, 0.0, 3.0 * GRAVITY])
    assert np.cross(arm, push) == pytest.approx(0.0, abs=1e-12)


def test_the_moment_about_the_centre_of_mass_is_the_rate_of_angular_momentum() -> None:
    rate = np.array([0.4, -0.3, 0.0])
    at = centre_of_pressure(STILL, np.zeros(3), rate)
    moment = np.cross([*at, 0.0] - STILL.com, [0.0, 0.0, 3.0 * GRAVITY])
    assert moment[:2] == pytest.approx(rate[:2])


def test_damping_with_omega_is_the_capture_point() -> None:
    body = moving((0.3, -0.1, 0.0), (0.0, 0.0, 0.0))
    assert desired_cp(body, body.omega, 0.0) == pytest.approx(capture_point(body))
    assert desired_cp(body, body.omega, 6.0) == pytest.approx(capture_point(body))


def test_a_body_that_turns_over_forward_wants_its_support_further_forward() -> None:
    body = moving((0.0, 0.0, 0.0), (0.0, 0.2, 0.0))
    at = desired_cp(body, body.omega, 6.0)
    assert at[0] > body.com[0]
    assert at[1] == pytest.approx(body.com[1])


def test_a_body_that_falls_freely_still_has_a_finite_point() -> None:
    at = centre_of_pressure(STILL, np.array([9.0, 0.0, -3.0 * GRAVITY]), np.zeros(3))
    assert np.all(np.isfinite(at))
    assert at[0] == pytest.approx(0.1 - 9.0 * 0.25 / (0.3 * 3.0 * GRAVITY))
