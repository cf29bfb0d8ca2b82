"""The smooth step: from 0 to 1 with no speed at either end."""

PEAK = 1.5
"""Ratio of its largest speed to its mean speed."""


def smooth_step(s: float) -> float:
    """Return 3 s^2 - 2 s^3, the part of the way done at the part `s`, 0 to 1, of the time.

    >>> smooth_step(0.0), smooth_step(0.5), smooth_step(1.0)
    (0.0, 0.5, 1.0)
    """
    return s * s * (3.0 - 2.0 * s)
