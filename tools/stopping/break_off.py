"""Ends a run, and the behaviour that it belongs to, while the robot stays held."""

from windup.control.loop import LoopReport, Until
from windup.hal.observation import Observation
from windup.tools.stopping.interrupts import BrokenOffError


class BreakOff:
    """Ends runs on the wish of whoever owns the robot.

    Args:
        wanted: Called with each observation of a run, except in its first motion and in a fall; a
            reason ends the run, with a `BrokenOffError`.
    """

    def __init__(self, wanted: Until) -> None:
        self._wanted = wanted
        self._reason: str | None = None

    def around(self, until: Until | None) -> Until:
        """Return `until`, followed by the wish to break off."""
        self._reason = None

        def either(observation: Observation) -> str | None:
            reason = None if until is None else until(observation)
            if reason is None:
                reason = self._reason = self._wanted(observation)
            return reason

        return either

    def check(self, report: LoopReport) -> None:
        """Raise if the last run was broken off.

        Raises:
            BrokenOffError: It was; the robot is held.
        """
        if self._reason is not None:
            raise BrokenOffError(report, self._reason)
