"""How long a value has to be beyond its level before that counts.

One wrong byte behind an 8-bit checksum counts for nothing: two readings of a joint, some time
apart and with none between them that is well, have to be beyond a level. Nor does a supply that
sags with every step, though a servo may be read so seldom that it does so at each of its readings:
all joints' readings for half a second have to be. One joint's alone, such as behind a bad
connector, are only warned of.
"""

import numpy as np

from windup.hal.guard.levels import HealthLevels, Kind
from windup.hal.joints import Array, Mask

DWELL = ({Kind.TEMPERATURE: 1.0, Kind.SUPPLY_LOW: 5.0, Kind.SUPPLY_HIGH: 5.0},
         {Kind.TEMPERATURE: 1.0, Kind.SUPPLY_LOW: np.inf, Kind.SUPPLY_HIGH: np.inf})  # fmt: skip
"""From a joint's first reading beyond the warning, and the stop, to the one that counts, s; load
and stall are times by themselves."""
TOGETHER = 0.5
"""The same for the readings of the supply of all joints, s."""
SAME = 1e-6
"""Times of one reading differ by rounding, s."""
FINE = 0.01
"""A supply at its level is not yet below or above it; servos tell it in steps of 0.1 V."""
SUPPLY = slice(Kind.SUPPLY_LOW, Kind.SUPPLY_HIGH + 1)
SIGNS = np.where(np.arange(len(Kind)) == Kind.SUPPLY_LOW, -1.0, 1.0)[:, None]
"""Sign of each kind: of a low supply less is worse."""


class Persistence:
    """Watches values (5, n), signed so that more is worse, against their two levels.

    Attributes:
        quiet: Nothing is beyond a warning.
    """

    def __init__(self, levels: HealthLevels) -> None:
        self._levels = SIGNS * np.stack((levels.warn, levels.stop))
        self._levels[:, SUPPLY] += FINE
        self._dwell = np.array([[dwell.get(kind, 0.0) for kind in Kind] for dwell in DWELL])[
            ..., None
        ]
        self.reset()

    def reset(self) -> None:
        """Forget all readings."""
        # When the first reading beyond the warning and the stop was, s: of each joint (2, 5, n),
        # and of all joints' supply, low and high (2, 2), there with the last one.
        self._since: Array = np.full(self._levels.shape, np.inf)
        self._first, self._last = np.full((2, 2), np.inf), np.full((2, 2), -np.inf)
        self._measured: Array = np.full(self._levels.shape[-1], -np.inf)
        self.quiet = True

    def due(self, values: Array, now: float, age: Array | None) -> Mask | None:
        """Return (2, 5, n) bool: what is beyond a warning, and a stop, for long enough.

        None stands for nothing at all.

        Args:
            values: (5, n) in the order of `Kind`, signed.
            now: s.
            age: (n,) of the readings of supply and temperature, s; None: they are of now.
        """
        before = self._measured
        self._measured = np.full(len(before), now) if age is None else now - age
        if self.quiet and not (values >= self._levels[0]).any():
            return None
        beyond = values >= self._levels
        at = np.full_like(values, now)
        at[: Kind.LOAD] = self._measured
        self._since = np.where(beyond, np.minimum(self._since, at), np.inf)
        self.quiet = not beyond[0].any()
        due = at - self._since >= self._dwell
        fresh = self._measured > before + SAME
        together = self._together(beyond[:, SUPPLY], values[SUPPLY], fresh, now)
        due[:, SUPPLY] |= beyond[:, SUPPLY] & together
        return due

    def beyond(self, values: Array) -> Mask:
        """Return (5, n) bool: which values are beyond their stop now."""
        return values >= self._levels[1]

    def _together(self, beyond: Mask, supply: Array, fresh: Mask, now: float) -> Mask:
        """Return (2, 2, 1) bool: all readings of the supply for long enough were `beyond`."""
        well = ((supply < self._levels[:, SUPPLY]) & fresh).any(axis=2)
        unwell = (beyond & fresh).any(axis=2)
        self._first = np.where(unwell, np.minimum(self._first, now), self._first)
        self._last = np.where(unwell, now, self._last)
        self._first[well | ~beyond.any(axis=2)] = np.inf
        return (self._last - self._first >= TOGETHER)[..., None]
