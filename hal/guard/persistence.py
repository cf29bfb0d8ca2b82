"""Time for which a value has to be beyond its level before it causes a warning or a stop.

A single wrong byte that passes an 8-bit checksum must not count: two readings of a joint, some time
apart and with no good one between them, have to be beyond a level. A supply that sags with every
step must not count either, even if a servo is read so seldom that each reading falls into a sag:
the readings of all joints have to be beyond the level for 0.5 s. A low or high supply of one joint
only, such as from a bad connector, causes a warning but no stop.
"""

import numpy as np

from windup.hal.guard.levels import HealthKind, HealthLevels
from windup.hal.joints import Array, Mask

DWELL = (
    {HealthKind.TEMPERATURE: 1.0, HealthKind.SUPPLY_LOW: 5.0, HealthKind.SUPPLY_HIGH: 5.0},
    {HealthKind.TEMPERATURE: 1.0, HealthKind.SUPPLY_LOW: np.inf, HealthKind.SUPPLY_HIGH: np.inf},
)
"""Minimum time from a joint's first reading beyond the warning, and the stop, until it takes
effect, s; load and stall need none, as they are averaged or timed already."""
TOGETHER = 0.5
"""Minimum time for which the supply readings of all joints have to be beyond a level, s."""
SAME = 1e-6
"""Rounding tolerance when timestamps of one reading are compared, s."""
FINE = 0.01
"""Margin by which the supply has to pass its level, V; servos report it in steps of 0.1 V."""
SUPPLY = slice(HealthKind.SUPPLY_LOW, HealthKind.SUPPLY_HIGH + 1)
SIGNS = np.where(np.arange(len(HealthKind)) == HealthKind.SUPPLY_LOW, -1.0, 1.0)[:, None]
"""Sign of each kind: values are multiplied by it so that larger is worse."""


class Persistence:
    """Compares values (5, n), signed so that larger is worse, with their two levels over time.

    Attributes:
        quiet: True while no value is beyond its warning level.
    """

    def __init__(self, levels: HealthLevels) -> None:
        self._levels = SIGNS * np.stack((levels.warn, levels.stop))
        self._levels[:, SUPPLY] += FINE
        self._dwell = np.array([[dwell.get(kind, 0.0) for kind in HealthKind] for dwell in DWELL])[
            ..., None
        ]
        self.reset()

    def reset(self) -> None:
        """Forget all readings."""
        # Times of the first reading beyond warning and stop, s: of each joint (2, 5, n), and of
        # the supply of all joints, low and high (2, 2); for the latter also of the last one.
        self._since: Array = np.full(self._levels.shape, np.inf)
        self._first, self._last = np.full((2, 2), np.inf), np.full((2, 2), -np.inf)
        self._measured: Array = np.full(self._levels.shape[-1], -np.inf)
        self.quiet = True

    def due(self, values: Array, now: float, age: Array | None) -> Mask | None:
        """Return (2, 5, n) bool: values beyond warning, and stop, for long enough.

        Returns None if there are none.

        Args:
            values: (5, n) in the order of `HealthKind`, signed.
            now: Present time, s.
            age: (n,) age of the supply and temperature readings, s; None for 0.
        """
        before = self._measured
        self._measured = np.full(len(before), now) if age is None else now - age
        if self.quiet and not (values >= self._levels[0]).any():
            return None
        beyond = values >= self._levels
        at = np.full_like(values, now)
        at[: HealthKind.LOAD] = self._measured
        self._since = np.where(beyond, np.minimum(self._since, at), np.inf)
        self.quiet = not beyond[0].any()
        due = at - self._since >= self._dwell
        fresh = self._measured > before + SAME
        together = self._together(beyond[:, SUPPLY], values[SUPPLY], fresh, now)
        due[:, SUPPLY] |= beyond[:, SUPPLY] & together
        return due

    def beyond_stop(self, values: Array) -> Mask:
        """Return (5, n) bool: values that are beyond their stop level now."""
        return values >= self._levels[1]

    def _together(self, beyond: Mask, supply: Array, fresh: Mask, now: float) -> Mask:
        """Return (2, 2, 1) bool: all supply readings for `TOGETHER` s or longer were `beyond`."""
        well = ((supply < self._levels[:, SUPPLY]) & fresh).any(axis=2)
        unwell = (beyond & fresh).any(axis=2)
        self._first = np.where(unwell, np.minimum(self._first, now), self._first)
        self._last = np.where(unwell, now, self._last)
        self._first[well | ~beyond.any(axis=2)] = np.inf
        return (self._last - self._first >= TOGETHER)[..., None]
