"""What a checksum lets through: of 8 bits one broken frame in 256, of any a servo of a wrong id.

A reading is believed if it lies within the encoder's range, if its velocity is one the motor has,
and if the position is no further from the last one than the motor can turn in the time between.
A joint that is not believed coasts, and the longer it coasts, the further it may have gone: after
a true jump it is believed again within a moment. But a servo that was silent for long may be nearly
anywhere: what is further off than it gets in `SURE`, and at the velocity that it reports, is
believed when a second reading agrees. So is the very first one behind a weak checksum, which has
nothing to be compared with.
"""

import numpy as np

from hal.joints import Array, Mask

FASTER = 1.5
"""How much faster than its data sheet says a servo may turn (supply, or driven from outside)."""
MARGIN = 0.02
"""Part of the encoder's range that a position may jump at no time at all: noise and rounding."""
SURE = 0.05
"""For so long the way that a servo may have gone says enough, s."""
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
        self._unit = velocity_unit
        self._fastest = self._reach / velocity_unit
        self._sure = self._margin + SURE * self._reach
        self._position: Array = np.zeros(len(last))
        self._when: Array = np.zeros(len(last))
        self._seen: Mask = np.zeros(len(last), dtype=bool)
        self._known: Mask = np.zeros(len(last), dtype=bool)
        self._twice: Mask = np.full(len(last), weak)  # whose next reading has to be confirmed
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
        way = np.abs(position - self._position)
        good = can_be & (way <= allowed)
        if (far := good & (way > self._sure)).any():
            fast = FASTER * np.abs(velocity) * self._unit * (now - self._when)
            self._doubt(far & (way > self._sure + fast))
        taken = good
        if not self._all_known:
            taken = good | can_be & ~self._known
            good = np.where(self._twice, good & self._seen, taken)
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
        self._twice.fill(self._weak)
        self._all_known = False

    def _doubt(self, far: Mask) -> None:
        """Have the next readings of some servos confirmed by those after them."""
        far = far & self._known
        self._twice[far] = True
        self._seen[far] = self._known[far] = False
        self._all_known = bool(self._known.all())
