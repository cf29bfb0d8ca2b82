"""How a foot and the centre of mass move in a step: curves of time alone.

Wu & Zordan 2010, sections 5.1 and 5.2.
"""

from math import erf, exp, pi, sin, sqrt

import numpy as np

from windup.hal.geometry.smooth_step import smooth_step
from windup.hal.joints import Array

WIDTH = 0.08
"""Width of the Gaussian speed profile, as the variance of a step that lasts 1 (section 5.1)."""


def gaussian_progress(s: float, width: float = WIDTH) -> float:
    """Return how much of the way, 0 to 1, is done at the part `s` of the time.

    The speed is a Gaussian about the middle of the step, cut off at its ends.
    """
    s = min(max(s, 0.0), 1.0)
    scale = 1.0 / sqrt(2.0 * width)
    whole = erf(0.5 * scale)
    return 0.5 * (1.0 + erf((s - 0.5) * scale) / whole)


def smooth_progress(s: float) -> float:
    """Return how much of the way, 0 to 1, is done at the part `s` of the time.

    The quintic with no speed and no acceleration at either end (minimum jerk).
    """
    s = min(max(s, 0.0), 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s * s)


def lift(s: float, height: float, early: float = 0.0) -> float:
    """Return how high the foot is, m, at the part `s` of the time.

    Args:
        s: 0 to 1.
        height: Highest, m.
        early: 0 peaks in the middle; up to 1 peaks sooner and comes down gently, as Kenwright
            2012 found in people (section V-B).
    """
    s = min(max(s, 0.0), 1.0)
    return height * sin(pi * s ** (1.0 / (1.0 + early))) * exp(-early * max(s - 0.5, 0.0))


def swing_foot(start: Array, target: Array, s: float, height: float) -> Array:
    """Return (3,) where the sole's centre should be at the part `s` of the time, m."""
    place = start + gaussian_progress(s) * (target - start)
    return place + np.array([0.0, 0.0, lift(s, height)])


def bezier(start: Array, pivot: Array, end: Array, s: float) -> Array:
    """Return the point of the quadratic Bezier curve from `start` by `pivot` to `end`.

    For the centre of mass these are where it is, the support foot, and the middle between that
    foot and where the other will come down (section 5.2); eased in and out.
    """
    s = min(max(s, 0.0), 1.0)
    eased = smooth_step(s)
    rest = 1.0 - eased
    return rest * rest * start + 2.0 * rest * eased * pivot + eased * eased * end
