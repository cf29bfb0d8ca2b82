"""Plausibility check of readings: rejects errors that pass the checksum.

An 8-bit checksum passes one corrupt frame in 256, and any checksum passes the answer of a servo
with a wrong id. A reading is accepted if its position is within the encoder's range, its velocity
within that of the motor, and its distance from the last position within what the motor can turn in
the time between. The allowed distance grows while readings are rejected, so that after a real jump
they are soon accepted again. A first reading has no reference: with a weak checksum it is accepted
only if a second one agrees.
"""

import numpy as np

from windup.hal.joints import Array, Mask

FASTER = 1.5
"""Factor by which a servo may exceed its data sheet speed (higher supply, or driven externally)."""
MARGIN = 0.02
"""Fraction of the encoder's range that a position may always jump, for noise and rounding."""
TURN = 4096.0
"""Maximum range used with `MARGIN`, for multi-turn servos, counts."""


class Plausibility:
    """The check of the n servos of one bus; positions are in counts.

    Args:
        last: (n,) largest count.
        speed: (n,) no-load speed, counts/s.
        velocity_unit: (n,) one unit of the velocity register, counts/s.
        weak: Whether a first reading has to be confirmed by a second one.
        first: (n,) smallest count; 0 by default.

    Attributes:
        rejected: Number of readings rejected; unconfirmed first readings do not count.
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
        """Return (n,) bool: valid and plausible readings.

        Args:
            position: (n,) counts.
            velocity: (n,) units of the velocity register.
            valid: (n,) bool, servos that answered.
            now: Present time, s.
        """
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

    def reset(self) -> None:
        """Reset: accept new first readings, as after a loss of power."""
        self._seen.fill(False)
        self._known.fill(False)
        self._all_known = False
