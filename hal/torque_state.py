"""Torque enable state of n joints: read back as on, read back as off, or unknown."""

from dataclasses import dataclass

import numpy as np

from windup.hal.joints import Joints, Mask


@dataclass(frozen=True)
class TorqueState:
    """Torque enable of n joints as read back. A joint that cannot be read is neither on nor off.

    Attributes:
        on: (n,) bool, read back as on.
        unknown: (n,) bool, could not be read.
    """

    on: Mask
    unknown: Mask

    @classmethod
    def known(cls, on: Mask) -> "TorqueState":
        """Return the state of joints that could all be read; `on` is (n,) bool."""
        return cls(on, np.zeros_like(on))

    @classmethod
    def unread(cls, n: int) -> "TorqueState":
        """Return the state of n joints of which none could be read."""
        return cls(np.zeros(n, dtype=bool), np.ones(n, dtype=bool))

    @property
    def off(self) -> Mask:
        """(n,) bool, read back as off."""
        off: Mask = ~(self.on | self.unknown)
        return off

    @property
    def all_on(self) -> bool:
        """True when every joint was read back as on."""
        return bool(self.on.all())

    @property
    def all_off(self) -> bool:
        """True when every joint was read back as off."""
        return bool(self.off.all())

    def names(self, joints: Joints, which: Mask) -> str:
        """Return the names of the joints `which` (n,) bool, or "all joints" if all are chosen."""
        if which.all() and len(which) > 1:
            return "all joints"
        return ", ".join(np.array(joints.names)[which])
