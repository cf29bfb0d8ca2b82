"""Places on the ground: arrays (3,) of x forward, m, y to the left, m, and yaw to the left, rad."""

from math import atan2, cos, sin

import numpy as np

from windup.hal.joints import Array


def onto(frame: Array, place: Array) -> Array:
    """Return `place` (3,), given relative to `frame` (3,), in the frame that `frame` is in."""
    x, y, yaw = frame
    c, s = cos(yaw), sin(yaw)
    turned = [x + c * place[0] - s * place[1], y + s * place[0] + c * place[1], yaw + place[2]]
    return np.array(turned)


def seen_from(frame: Array, place: Array) -> Array:
    """Return `place` (3,) relative to `frame` (3,); its yaw is in -pi .. pi."""
    c, s = cos(frame[2]), sin(frame[2])
    dx, dy, turn = place - frame
    return np.array([c * dx + s * dy, -s * dx + c * dy, atan2(sin(turn), cos(turn))])


def between(one: Array, other: Array) -> Array:
    """Return the place (3,) halfway between two places (3,)."""
    away = seen_from(one, other)
    middle = onto(one, np.array([0.0, 0.0, 0.5 * away[2]]))
    middle[:2] = 0.5 * (one[:2] + other[:2])
    return middle


def ground_places(position: Array, frames: Array) -> Array:
    """Return the places (k, 3) of soles, from their positions (k, 3) m and axes (k, 9)."""
    axes = frames.reshape(-1, 3, 3)
    yaw = np.arctan2(axes[:, 1, 0], axes[:, 0, 0])
    return np.column_stack([position[:, :2], yaw])
