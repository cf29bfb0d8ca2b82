"""The smooth step: from 0 to 1 with no speed at either end."""

PEAK = 1.5
"""Its largest speed over its mean."""


def smooth_step(s: float) -> float:
    """Return 3 s^2 - 2 s^3: how much of a way is done at the part `s`, 0 to 1, of its time.

    >>> smooth_step(0.0), smooth_step(0.5), smooth_step(1.0)
    (0.0, 0.5, 1.0)
    """
    return s * s * (3.0 - 2.0 * s)
