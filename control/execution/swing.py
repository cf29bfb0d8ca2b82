"""Curves of the swing foot and of the centre of mass in a step, as functions of time alone.

Wu & Zordan 2010, sections 5.1 and 5.2.
"""

from math import erf, exp, pi, sin, sqrt

import numpy as np

from windup.hal.geometry.smooth_step import smooth_step
from windup.hal.joints import Array

WIDTH = 0.08
"""Variance of the Gaussian speed profile, for a step of duration 1 (section 5.1)."""


def gaussian_progress(s: float, width: float = WIDTH) -> float:
    """Return the fraction of the path, 0 to 1, that is done at the fraction `s` of the time.

    The speed is a Gaussian about the middle of the step, truncated at its ends.
    """
    s = min(max(s, 0.0), 1.0)
    scale = 1.0 / sqrt(2.0 * width)
    whole = erf(0.5 * scale)
    return 0.5 * (1.0 + erf((s - 0.5) * scale) / whole)


def smooth_progress(s: float) -> float:
    """Return the fraction of the path, 0 to 1, that is done at the fraction `s` of the time.

    This is the quintic with zero speed and acceleration at both ends (minimum jerk).
    """
    s = min(max(s, 0.0), 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s * s)


def lift(s: float, height: float, early: float = 0.0) -> float:
    """Return the height of the foot, m, at the fraction `s` of the time.

    Args:
        s: 0 to 1.
        height: Peak height, m.
        early: 0 peaks in the middle; values up to 1 peak sooner and come down more slowly, as
            Kenwright 2012 found in people (section V-B).
    """
    s = min(max(s, 0.0), 1.0)
    return height * sin(pi * s ** (1.0 / (1.0 + early))) * exp(-early * max(s - 0.5, 0.0))


def swing_foot(start: Array, target: Array, s: float, height: float) -> Array:
    """Return the position (3,) of the sole's centre at the fraction `s` of the time, m."""
    place = start + gaussian_progress(s) * (target - start)
    return place + np.array([0.0, 0.0, lift(s, height)])


def bezier(start: Array, pivot: Array, end: Array, s: float) -> Array:
    """Return the point of the quadratic Bezier curve from `start` by `pivot` to `end`.

    For the centre of mass these are its start, the stance foot, and the middle between that foot
    and the target of the swing foot (section 5.2). The speed is zero at both ends.
    """
    s = min(max(s, 0.0), 1.0)
    eased = smooth_step(s)
    rest = 1.0 - eased
    return rest * rest * start + 2.0 * rest * eased * pivot + eased * eased * end
