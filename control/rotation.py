"""Headings and rotation vectors of rotation matrices (3, 3)."""

import numpy as np

from hal.joints import Array


def yaw_of(rotation: Array) -> float:
    """Return the heading of a rotation matrix, rad."""
    return float(np.arctan2(rotation[1, 0], rotation[0, 0]))


def rotation_vector(matrix: Array) -> Array:
    """Return the rotation vector (3,) rad of a rotation matrix that turns less than half round."""
    axis = np.array(
        [
            matrix[2, 1] - matrix[1, 2],
            matrix[0, 2] - matrix[2, 0],
            matrix[1, 0] - matrix[0, 1],
        ]
    )
    angle = np.arctan2(0.5 * np.linalg.norm(axis), 0.5 * (np.trace(matrix) - 1.0))
    return np.asarray(0.5 * axis / max(np.sinc(angle / np.pi), 1e-3))
