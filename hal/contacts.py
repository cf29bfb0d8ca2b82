"""The contact sensors of a robot, grouped by foot."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from windup.hal.errors import UnknownNameError
from windup.hal.joints import Array, Mask
from windup.hal.mirror import Side, side_of


@dataclass(frozen=True)
class ContactSensors:
    """Names of the k contact sensors and the feet they belong to.

    A contact that a gait waits for is named by one sensor or by a foot (any of its sensors).

    Attributes:
        names: The k sensor names, in the order of `Observation.contacts`.
        feet: Maps foot name to the names of its sensors; by convention left before right.
        sides: Side of each foot; if empty, the side is taken from the foot's name.
        threshold: Normal force above which a sensor counts as pressed, N.
    """

    names: tuple[str, ...]
    feet: dict[str, tuple[str, ...]]
    threshold: float = 1.0
    sides: tuple[Side | Literal[""], ...] = ()
    members: Mask = field(init=False, repr=False)

    def __post_init__(self) -> None:
        rows = [self.mask(foot) for foot in self.feet]
        members = np.array(rows, dtype=bool).reshape(len(self.feet), len(self.names))
        object.__setattr__(self, "members", members)

    @property
    def foot_names(self) -> tuple[str, ...]:
        """Names of the feet, in the order of `feet`."""
        return tuple(self.feet)

    def is_left(self, foot: int) -> bool:
        """Return whether the foot with index `foot` is the left one."""
        side = self.sides[foot] if self.sides else side_of(self.foot_names[foot])
        return side == "left"

    def mask(self, name: str) -> Mask:
        """Return (k,) bool: the sensors of the foot `name`, or the single sensor `name`.

        Raises:
            UnknownNameError: `name` is neither a foot nor a sensor.
        """
        if name in self.feet:
            chosen: Iterable[str] = self.feet[name]
        elif name in self.names:
            chosen = (name,)
        else:
            raise UnknownNameError("contact", name, (*self.feet, *self.names))
        chosen = set(chosen)
        return np.array([sensor in chosen for sensor in self.names], dtype=bool)

    def pressed(self, contacts: Array) -> Mask:
        """Return (..., k) bool: which sensors are pressed, from forces (..., k) N."""
        return np.asarray(contacts > self.threshold)

    def feet_down(self, contacts: Array) -> Mask:
        """Return (..., feet) bool: which feet have a pressed sensor, from forces (..., k) N."""
        return np.asarray((self.pressed(contacts)[..., None, :] & self.members).any(axis=-1))
