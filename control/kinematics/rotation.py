"""Rotation matrices (3, 3), headings, and differences between them."""

from math import atan2, cos, hypot, sin

import mujoco
import numpy as np

from windup.hal.joints import Array


def yaw_of(rotation: Array) -> float:
    """Return the yaw of a rotation matrix, from its x axis, rad."""
    return atan2(rotation[1, 0], rotation[0, 0])


def facing(rotation: Array) -> float:
    """Return the heading of a base, from the y axis of its rotation matrix, rad.

    It is the heading of `heading`.
    """
    return atan2(-rotation[0, 1], rotation[1, 1])


def turn(yaw: float) -> Array:
    """Return the rotation matrix (3, 3) of a rotation about the vertical by `yaw` rad."""
    c, s = cos(yaw), sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def heading_between(one: float, other: float, part: float) -> float:
    """Return the heading at the fraction `part` of the shorter arc from `one` to `other`, rad."""
    return one + part * way_round(one, other)


def turn_about_y(pitch: float) -> Array:
    """Return the matrix (3, 3) of a rotation about y by `pitch` rad; positive leans forward."""
    c, s = cos(pitch), sin(pitch)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def quaternion_matrix(orientation: Array) -> Array:
    """Return the rotation matrix (3, 3) of a quaternion (4,) wxyz."""
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, orientation)
    return matrix.reshape(3, 3)


def turn_between(one: Array, other: Array) -> Array:
    """Return the rotation vector (3,) rad from `one` to `other`, in their common parent frame."""
    (a, b, c), (d, e, f), (g, h, i) = (other @ one.T).tolist()
    x, y, z = 0.5 * (h - f), 0.5 * (c - g), 0.5 * (d - b)
    size = hypot(x, y, z)
    factor = 1.0 if size < 1e-9 else atan2(size, 0.5 * (a + e + i - 1.0)) / size
    return np.array([factor * x, factor * y, factor * z])


def way_round(one: float, other: float) -> float:
    """Return the signed shorter angle from one direction to another, rad."""
    return atan2(sin(other - one), cos(other - one))


def lying(normal: Array, yaw: float) -> Array:
    """Return the rotation (3, 3) of a body that lies flat on ground of a unit `normal` (3,).

    Its x axis, projected on the horizontal plane, has the heading `yaw`, rad.
    """
    c, s = cos(yaw), sin(yaw)
    along = np.array([c, s, -(c * normal[0] + s * normal[1]) / normal[2]])
    along /= np.linalg.norm(along)
    return np.column_stack([along, np.cross(normal, along), normal])


def heading(orientation: Array) -> Array:
    """Return the headings (...,) of a base, rad, from quaternions (..., 4) wxyz.

    The forward direction is orthogonal to the ground-plane projection of the line that joins the
    hips, which is the base's y axis (Laszlo 1996, section 3.5).
    """
    w, x, y, z = np.moveaxis(orientation, -1, 0)
    left_x, left_y = 2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z)
    return np.arctan2(-left_x, left_y)
