"""The few operations on unit quaternions (wxyz) that an IMU's frames need."""

from math import atan2, cos, sin

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


def rotation_between(before: Array, after: Array) -> Array:
    """Return the rotation vector (3,) rad, in the body, from one orientation to the next."""
    turn = multiply(conjugate(before), after)
    size = float(np.linalg.norm(turn[1:]))
    if size < 1e-12:
        return np.zeros(3)
    # The shorter way round: a quaternion and its negative are one orientation.
    angle = 2.0 * atan2(size, abs(turn[0]))
    return np.asarray(turn[1:] * (np.copysign(angle, turn[0]) / size))
