"""Rotation matrices (3, 3): made from headings and quaternions, and what lies between two."""

from math import atan2, cos, remainder, sin, tau

import mujoco
import numpy as np

from hal.joints import Array


def yaw_of(rotation: Array) -> float:
    """Return the heading of a rotation matrix, rad."""
    return atan2(rotation[1, 0], rotation[0, 0])


def turn(yaw: float) -> Array:
    """Return the rotation matrix (3, 3) of a turn about the vertical, rad."""
    c, s = cos(yaw), sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def heading_between(one: float, other: float, part: float) -> float:
    """Return the heading after a `part` of the shorter way from `one` to `other`, rad."""
    return one + part * remainder(other - one, tau)


def turn_about_y(pitch: float) -> Array:
    """Return the rotation matrix (3, 3) of a turn about the y axis, rad; positive leans forward."""
    c, s = cos(pitch), sin(pitch)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def quaternion_matrix(orientation: Array) -> Array:
    """Return the rotation matrix (3, 3) of a quaternion (4,) wxyz."""
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, orientation)
    return matrix.reshape(3, 3)


def turn_between(one: Array, other: Array) -> Array:
    """Return the turn (3,) rad, in the frame that both are seen from, from `one` to `other`."""
    way = other @ one.T
    sine = 0.5 * np.array([way[2, 1] - way[1, 2], way[0, 2] - way[2, 0], way[1, 0] - way[0, 1]])
    size = float(np.sqrt(sine @ sine))
    if size < 1e-9:
        return sine
    return sine * (np.arctan2(size, 0.5 * (np.trace(way) - 1.0)) / size)
