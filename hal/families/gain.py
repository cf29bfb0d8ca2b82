"""The gain register that sets a servo's stiffness: its range, resolution and encoding."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from windup.hal.joints import Array
from windup.hal.registers import Register


@dataclass(frozen=True, eq=False)
class Gain:
    """The P register of a servo, or the register that has its function.

    Attributes:
        register: The register.
        top: Maximum P.
        nearest: Returns the nearest realisable P (n,) for P (n,), before the limit.
        counts: Returns the register values (n,) for P (n,).
    """

    register: Register
    top: float
    nearest: Callable[[Array], Array] = np.rint
    counts: Callable[[Array], Array] = np.asarray

    def within(self, wanted: Array) -> Array:
        """Return `wanted` (n,) clamped to the range of P."""
        return np.asarray(np.clip(wanted, 0.0, self.top))


def slope_steps(p: Array) -> Array:
    """Return the nearest P (n,) of an AX: 1024 / slope, with slopes of 2, 4, ... 128 counts."""
    steps = np.rint(np.log2(np.maximum(p, 1e-9)))
    return np.asarray(np.exp2(np.clip(steps, 3.0, 9.0)))


def slope_pair(p: Array) -> Array:
    """Return the two-byte compliance slopes (n,) of an AX, equal on both sides of the goal."""
    slope = 1024.0 / p
    return np.asarray(slope + 256.0 * slope)
