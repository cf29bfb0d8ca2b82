"""How a servo's stiffness is set: which register, how far it goes, which steps it has."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from windup.hal.joints import Array
from windup.hal.registers import Register


@dataclass(frozen=True, eq=False)
class Gain:
    """The P register of a servo, or what stands for one.

    Attributes:
        register: Where it is.
        top: Largest P.
        nearest: P (n,) to the nearest ones there are, before the limit.
        counts: P (n,) to what is written into `register`.
    """

    register: Register
    top: float
    nearest: Callable[[Array], Array] = np.rint
    counts: Callable[[Array], Array] = np.asarray

    def within(self, wanted: Array) -> Array:
        """Return the nearest P (n,) that the servo has."""
        return np.asarray(np.clip(wanted, 0.0, self.top))


def slope_steps(p: Array) -> Array:
    """Return the nearest P (n,) of an AX: 1024 over a slope of 2, 4, ... 128 counts."""
    steps = np.rint(np.log2(np.maximum(p, 1e-9)))
    return np.asarray(np.exp2(np.clip(steps, 3.0, 9.0)))


def slope_pair(p: Array) -> Array:
    """Return the compliance slopes (n,) of an AX, the same on both sides of the goal."""
    slope = 1024.0 / p
    return np.asarray(slope + 256.0 * slope)
