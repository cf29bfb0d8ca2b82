"""Operations on one unit quaternion, wxyz, for what is computed in every tick.

`scipy.spatial.transform.Rotation` has them all, but takes ten times as long for one rotation.
"""

from math import asin, atan2, cos, sin

import numpy as np

from windup.hal.joints import Array


def multiply(a: Array, b: Array) -> Array:
    """Return the product of two (4,) quaternions: first `b`, then `a`."""
    w, v, x, u = a[0], a[1:], b[0], b[1:]
    return np.concatenate([[w * x - v @ u], w * u + x * v + np.cross(v, u)])


def conjugate(a: Array) -> Array:
    """Return the inverse (4,) of a unit quaternion."""
    return a * np.array([1.0, -1.0, -1.0, -1.0])


def rotate(a: Array, vector: Array) -> Array:
    """Return `vector` (3,) turned by a unit quaternion."""
    twice = 2.0 * np.cross(a[1:], vector)
    return np.asarray(vector + a[0] * twice + np.cross(a[1:], twice))


def euler_zxy(yaw: float, pitch: float, roll: float) -> Array:
    """Return the quaternion (4,) of Rz(yaw) Rx(pitch) Ry(roll), rad."""
    about_z = np.array([cos(yaw / 2), 0.0, 0.0, sin(yaw / 2)])
    about_x = np.array([cos(pitch / 2), sin(pitch / 2), 0.0, 0.0])
    about_y = np.array([cos(roll / 2), 0.0, sin(roll / 2), 0.0])
    return multiply(multiply(about_z, about_x), about_y)


def zxy_angles(orientation: Array) -> tuple[float, float, float]:
    """Return the angles about z, then x, then y of a quaternion (4,), rad; see `euler_zxy`."""
    w, x, y, z = orientation.tolist()
    return (
        atan2(2.0 * (w * z - x * y), 1.0 - 2.0 * (x * x + z * z)),
        asin(max(-1.0, min(1.0, 2.0 * (w * x + y * z)))),
        atan2(2.0 * (w * y - x * z), 1.0 - 2.0 * (x * x + y * y)),
    )


def roll_pitch_yaw(orientation: Array) -> tuple[float, float, float]:
    """Return the angles about x, then y, then z (fixed axes) of a quaternion (4,), rad."""
    w, x, y, z = orientation.tolist()
    return (
        atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x)))),
        atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
    )


def rotation_between(before: Array, after: Array) -> Array:
    """Return the rotation vector (3,) rad, in the body, from one orientation to the next."""
    turn = multiply(conjugate(before), after)
    size = float(np.linalg.norm(turn[1:]))
    if size < 1e-12:
        return np.zeros(3)
    # The shorter way round: a quaternion and its negative are one orientation.
    angle = 2.0 * atan2(size, abs(turn[0]))
    return np.asarray(turn[1:] * (np.copysign(angle, turn[0]) / size))
