"""The clamps of the servo driver: how often each acted, and at which joints in the last command."""

from collections import Counter

import numpy as np
import numpy.typing as npt

from windup.hal.joints import Flags, Mask
from windup.hal.servo_bus.coupling import Couplings

NAMES = ("goal", "gain", "unarmed", "lost")


class DriverClamps:
    """Counts the clamps of a driver of n servos.

    Args:
        couplings: Joints that are driven by two servos together.
        servos: Number n of servos.

    Attributes:
        counts: Maps clamp to the number of commands it changed.
        bits: (n,) bits of the clamps, in the order of `counts`, that changed each joint's part of
            the last command; None if none did.
    """

    def __init__(self, couplings: Couplings, servos: int) -> None:
        self.counts: Counter[str] = Counter(dict.fromkeys(NAMES, 0))
        self.bits: Flags | None = None
        self._couplings, self._servos = couplings, servos
        self._gains: Flags | None = None

    def note_gains(self, beyond: Mask) -> None:
        """Note the gains just sent; those `beyond` (n,) their registers stay clamped until others.

        A clamped gain is counted once, when it is sent.
        """
        clamped = bool(beyond.any())
        self.counts["gain"] += clamped
        self._gains = self._at("gain", beyond) if clamped else None

    def begin(self) -> None:
        """Begin a command; only the gains may be clamped in it so far."""
        self.bits = self._gains

    def note(self, name: str, servos: Mask) -> None:
        """Note a clamp of the present command at some `servos` (n,) bool."""
        self.counts[name] += 1
        found = self._at(name, servos)
        self.bits = found if self.bits is None else self.bits | found

    def note_withheld(self, name: str, rows: npt.NDArray[np.intp], withheld: Mask | None) -> None:
        """Note goals withheld from a bus, or from those of its servos that are `withheld`.

        Args:
            name: The clamp: "unarmed" for the whole bus, "lost" for some servos of it.
            rows: (servos,) indices of the servos of the bus.
            withheld: (servos,) bool, or None.
        """
        servos = np.zeros(self._servos, dtype=bool)
        servos[rows[withheld] if name == "lost" and withheld is not None else rows] = True
        self.note(name, servos)

    def _at(self, name: str, servos: Mask) -> Flags:
        """Return (n,) the bit of a clamp at the joints that these servos drive."""
        bit = np.uint32(1 << NAMES.index(name))
        return self._couplings.any(servos) * bit
