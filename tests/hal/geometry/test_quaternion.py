"""The functions of the hot path agree with SciPy's rotations."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from windup.hal.geometry import quaternion
from windup.hal.geometry.quaternion import euler_zxy, roll_pitch_yaw, zxy_angles
from windup.hal.joints import Array

ONE, OTHER = (Rotation.random(20, np.random.default_rng(seed)) for seed in (1, 2))
PAIRS = list(zip(ONE, OTHER, strict=True))


def wxyz(rotation: Rotation) -> Array:
    return np.asarray(rotation.as_quat(scalar_first=True))


def same(one: Rotation, quaternion: Array) -> bool:
    away = one * Rotation.from_quat(quaternion, scalar_first=True).inv()
    return bool(away.magnitude() < 1e-9)


@pytest.mark.parametrize(("one", "other"), PAIRS)
def test_products_inverses_and_rotated_vectors(one: Rotation, other: Rotation) -> None:
    a, b, vector = wxyz(one), wxyz(other), np.array([0.3, -0.4, 1.2])
    assert same(one * other, quaternion.multiply(a, b))
    assert same(one.inv(), quaternion.conjugate(a))
    np.testing.assert_allclose(quaternion.rotate(a, vector), one.apply(vector), atol=1e-12)


@pytest.mark.parametrize(("one", "other"), PAIRS)
def test_the_rotation_between_two_orientations_is_the_shorter_one(
    one: Rotation, other: Rotation
) -> None:
    wanted = (one.inv() * other).as_rotvec()
    for sign in (1.0, -1.0):
        found = quaternion.rotation_between(wxyz(one), sign * wxyz(other))
        np.testing.assert_allclose(found, wanted, atol=1e-9)


@pytest.mark.parametrize("one", list(ONE))
def test_angles_about_three_axes(one: Rotation) -> None:
    angles = zxy_angles(wxyz(one))
    np.testing.assert_allclose(angles, one.as_euler("ZXY"), atol=1e-9)
    assert same(one, euler_zxy(*angles))
    np.testing.assert_allclose(roll_pitch_yaw(wxyz(one)), one.as_euler("xyz"), atol=1e-9)


def test_at_the_end_of_the_middle_angle_the_others_are_still_numbers() -> None:
    upright = Rotation.from_euler("y", np.pi / 2.0)
    roll, pitch, yaw = roll_pitch_yaw(wxyz(upright))
    assert pitch == pytest.approx(np.pi / 2.0) and np.isfinite([roll, yaw]).all()
