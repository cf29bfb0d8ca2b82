"""How close to a limit cycle a motion is."""

import numpy as np

from windup.hal.joints import Array
from windup.tools.reproduce.laszlo.recorder import column
from windup.tools.reproduce.study.figure import Result

CYCLES = 10  # the last ones; a cycle is two steps
PHASES = 50
CLEAR = 0.15


def cycles(result: Result, names: tuple[str, str]) -> Array:
    """Return the last cycles (c, PHASES, 2) of two columns of a trace, over the phase."""
    step = column(result, "step").astype(int)
    xy = np.stack([column(result, name) for name in names], axis=-1)
    whole = result["steps"] // 2
    found = []
    for number in range(max(whole - CYCLES, 2), whole):  # the first two are the start
        rows = xy[(step == 2 * number) | (step == 2 * number + 1)]
        if len(rows) > 5:
            phase = np.linspace(0.0, 1.0, len(rows))
            at = np.linspace(0.0, 1.0, PHASES)
            found.append(np.stack([np.interp(at, phase, rows[:, i]) for i in (0, 1)], axis=-1))
    return np.array(found).reshape(-1, PHASES, 2)


def scatter(result: Result, names: tuple[str, str] = ("up.f", "up.l")) -> float:
    """Return how far cycles lie apart, over the size of a cycle: 0 is a limit cycle.

    NaN where there are fewer than three cycles past the start.
    """
    orbit = cycles(result, names)
    if len(orbit) < 3:
        return float("nan")
    apart = np.sqrt(np.mean(orbit.var(axis=0)))
    size = np.sqrt(np.mean(orbit.mean(axis=0).var(axis=0)))
    return float(apart / max(size, 1e-9))


def pitch_range(result: Result) -> float:
    """Return the range of the torso's pitch over a cycle, degrees (median of the last ones)."""
    orbit = cycles(result, ("up.f", "up.l"))
    if not len(orbit):
        return float("nan")
    return float(np.degrees(np.median(np.ptp(np.arcsin(orbit[:, :, 0]), axis=1))))
