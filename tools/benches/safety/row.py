"""One row of the table: a way to end a run, and the criteria of a safe ending."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from windup.hal.guard import CROUCH_SECONDS
from windup.tools.benches.safety.moment import ACTIVITIES, Activity
from windup.tools.benches.safety.standard_error import Errors
from windup.tools.benches.safety.trial import Trial

End = Literal["off", "frozen", "unknown", "unattended"]
"""State after the end: torque off at every servo that answers; every servo frozen by its bus
watchdog; no answer, with a guardian that keeps trying; no answer, and no guardian."""

STOP = 0.25
"""Longest time from an ending to no driven motor, s."""
HANG = 0.30
"""The same if only the guardian's time-out detects the ending, s."""
SLACK = 0.15
"""Tolerance of the duration of a crouch, s."""


@dataclass(frozen=True)
class Ending:
    """A way to end a run.

    Attributes:
        name: Name in the table.
        carry_out: Ends the run; returns t0, s on the monotonic clock.
        status: The correct exit statuses; a negative one is the number of a signal.
        within: Longest time from t0 until no motor is driven, without a crouch, s.
        crouch: Whether a robot whose stop policy is a crouch may take the additional time for it.
        end: Expected state after the end.
        start: Description of t0.
        fault: Fault of the program itself; "" if it has none.
        activities: Activities in which it is tried.
        robots: Robots with which it is tried; all if empty.
        network: Whether the robot is connected by TCP.
        errors: Kind of standard error of program and guardian.
    """

    name: str
    carry_out: Callable[[Trial], float]
    status: tuple[int, ...]
    within: float = STOP
    crouch: bool = True
    end: End = "off"
    start: str = "the moment itself"
    fault: str = ""
    activities: tuple[Activity, ...] = ACTIVITIES
    robots: tuple[str, ...] = ()
    network: bool = False
    errors: Errors = "a file"

    def allowed(self, crouches: bool) -> float:
        """Return the longest time allowed for a robot that crouches, or does not, s."""
        return self.within + (CROUCH_SECONDS + SLACK if crouches and self.crouch else 0.0)
