"""What a checksum lets through: of 8 bits one broken frame in 256, of any a servo of a wrong id.

A reading is believed if it lies within the encoder's range, if its velocity is one the motor has,
and if the position is no further from the last one than the motor can turn in the time between.
A joint that is not believed coasts, and the longer it coasts, the further it may have gone: after
a true jump it is believed again within a moment. The very first reading has nothing to be compared
with: behind a weak checksum it is believed when a second one agrees.
"""

import numpy as np

from windup.hal.joints import Array, Mask

FASTER = 1.5
"""How much faster than its data sheet says a servo may turn (supply, or driven from outside)."""
MARGIN = 0.02
"""Part of the encoder's range that a position may jump at no time at all: noise and rounding."""
TURN = 4096.0
"""That range of servos that count many turns, counts."""


class Plausibility:
    """The check of one line of n servos; everything in counts.

    Args:
        last: (n,) largest count.
        speed: (n,) counts a second without load.
        velocity_unit: (n,) counts a second of one unit of the velocity register.
        weak: Does a first reading need a second one that agrees?
        first: (n,) smallest count; 0 by default.

    Attributes:
        rejected: How many readings have been refused, first ones apart.
    """

    def __init__(
        self,
        last: Array,
        speed: Array,
        velocity_unit: Array,
        weak: bool = True,
        first: Array | None = None,
    ) -> None:
        self._first = np.zeros(len(last)) if first is None else first
        self._last, self._weak = last, weak
        self._reach = FASTER * speed
        self._margin = MARGIN * np.minimum(last + 1.0, TURN)
        self._fastest = self._reach / velocity_unit
        self._position: Array = np.zeros(len(last))
        self._when: Array = np.zeros(len(last))
        self._seen: Mask = np.zeros(len(last), dtype=bool)
        self._known: Mask = np.zeros(len(last), dtype=bool)
        self._all_known = False
        self.rejected = 0

    def accept(self, position: Array, velocity: Array, valid: Mask, now: float) -> Mask:
        """Return (n,) bool: `valid` and believable. Position and velocity are (n,) counts."""
        can_be = (
            (position >= self._first)
            & (position <= self._last)
            & (np.abs(velocity) <= self._fastest)
        )
        can_be &= valid
        allowed = self._margin + self._reach * (now - self._when)
        near = np.abs(position - self._position) <= allowed
        good = can_be & near
        taken = good
        if not self._all_known:
            taken = good | can_be & ~self._known
            good = good & self._seen if self._weak else taken
            self._seen |= taken
            self._known |= good
            self._all_known = bool(self._known.all())
        self.rejected += int(np.count_nonzero(valid)) - int(np.count_nonzero(taken))
        np.copyto(self._position, position, where=taken)
        np.copyto(self._when, now, where=taken)
        return good

    def forget(self) -> None:
        """Start anew, wherever the servos are now, as after they had no power."""
        self._seen.fill(False)
        self._known.fill(False)
        self._all_known = False
