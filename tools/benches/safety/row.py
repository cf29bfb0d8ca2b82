"""One row of the table: a way to end a run, and what a safe ending looks like."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from windup.hal.guard import CROUCH_SECONDS
from windup.tools.benches.safety.moment import ACTIVITIES, Activity
from windup.tools.benches.safety.standard_error import Errors
from windup.tools.benches.safety.trial import Trial

End = Literal["off", "frozen", "unknown", "unattended"]
"""What is found afterwards: torque off at every servo that answers; every servo frozen by its bus
watchdog; no answer, and a guardian that goes on trying; no answer, and nobody left to try."""

STOP = 0.25
"""From an ending to no driven motor, s."""
HANG = 0.30
"""The same where nobody but the guardian's patience tells, s."""
SLACK = 0.15
"""What a crouch may take longer than it is meant to, s."""


@dataclass(frozen=True)
class Row:
    """A way to end a run.

    Attributes:
        name: As the table has it.
        do: Makes it happen; returns t0, s on the monotonic clock.
        status: The exit statuses that are right; negative is the number of a signal.
        within: From t0 to the last driven motor let go, s, a crouch apart.
        crouch: A robot whose policy is a crouch may take its time for it.
        end: What is read afterwards.
        start: What t0 is.
        fault: What the program itself does wrong; "" where it is innocent.
        activities: When it is tried.
        robots: With which robots; all if empty.
        network: The robot is behind TCP.
        errors: What standard error is to program and guardian.
    """

    name: str
    do: Callable[[Trial], float]
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
        """Return how long it may take with a robot that crouches, or not, s."""
        return self.within + (CROUCH_SECONDS + SLACK if crouches and self.crouch else 0.0)
