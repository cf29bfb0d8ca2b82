"""When evenly sent frames came, for a host that looks at its port only now and then."""

from math import inf

CREEP = 5e-4
"""How much longer than it says the sender's period may be, as a share."""
LATEST = 0.05
"""A frame seen so long after it was due tells of a sender that paused, s."""


class FrameClock:
    """Dates frames that are numbered and come at an even rate.

    A frame is seen late, by up to the time between two looks, and never early. So the earliest of
    the sightings, carried along at the sender's period, dates the frames that follow.

    Args:
        period: From one frame to the next, s.
        turn: Numbers there are; the count begins again at 0.
    """

    def __init__(self, period: float, turn: int = 256) -> None:
        self._period, self._turn = period * (1.0 + CREEP), turn
        self.reset()

    def reset(self) -> None:
        """Forget the sender."""
        self._number, self._came = 0, -inf

    def timestamp(self, number: int, seen: float) -> float:
        """Return when the frame came, s, that was `seen` then."""
        due = self._came + (number - self._number) % self._turn * self._period
        self._came = seen if seen - due > LATEST else min(seen, due)
        self._number = number
        return self._came
