"""Findings of the health and IMU checks: kind, joints, worst value and limit; one per cause."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from windup.hal.guard.levels import HealthKind

MAX_NAMED = 3
"""Maximum number of joints that a message names; more are counted."""


CHECK, AGAIN = "check its cable and power", "switch it off and on"
"""Remedies for a part that is silent, and for one that sends wrong values."""


class FindingText(NamedTuple):
    """Texts of one kind of finding.

    Attributes:
        name: Name of the kind, for programs.
        state: Format of the state, with the worst value.
        level: Format of the limit.
        remedy: Remedy.
        scale: Factor from the value to the printed number.
        subject: The part concerned if it is not a joint.
        low: Whether lower values are worse.
    """

    name: str
    state: str
    level: str
    remedy: str
    scale: float = 1.0
    subject: str = ""
    low: bool = False


FINDING_TEXTS = {
    HealthKind.SUPPLY_LOW: FindingText(
        "supply low", "on {:.1f} V", "below {:.1f}", "charge the battery, or check its connector",
        low=True,
    ),
    HealthKind.SUPPLY_HIGH: FindingText(
        "supply high", "on {:.1f} V", "above {:.1f}", "switch the power off: it is the wrong supply"
    ),
    HealthKind.TEMPERATURE: FindingText(
        "temperature", "at {:.0f} degrees C", "at {:.0f}",
        "let it cool; a pose with less load helps",
    ),
    HealthKind.LOAD: FindingText(
        "load", "at {:.0f} % of stall torque for a second", "at {:.0f} %",
        "take a pose with less load, or carry less", 100.0,
    ),
    HealthKind.STALL: FindingText(
        "stall", "blocked at full torque for {:.1f} s", "at {:.1f} s", "remove what blocks it"
    ),
}  # fmt: skip


def format_names(joints: Iterable[str]) -> str:
    """Return up to `MAX_NAMED` names as text, or the number of joints.

    >>> format_names(["l_knee", "r_knee"]), format_names("abcd")
    ('l_knee and r_knee', '4 joints')
    """
    names = list(joints)
    if len(names) > MAX_NAMED:
        return f"{len(names)} joints"
    return " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


@dataclass
class Finding:
    """One cause of a warning or a stop, with all joints it was found at.

    Attributes:
        text: Texts of its kind.
        value: The worst value.
        limit: The level that was exceeded, at the joint with the worst value.
        since: Time when it was first found, s on the backend's clock.
        stop: Whether it is a reason to stop.
        joints: Names of the joints.
        count: Number of times that it began at one of the joints.
    """

    text: FindingText
    value: float
    limit: float
    since: float
    stop: bool = False
    joints: list[str] = field(default_factory=list)
    count: int = 0

    @property
    def description(self) -> str:
        """Text of the state and of the level that was exceeded."""
        text = self.text
        state = text.state.format(self.value * text.scale)
        level = text.level.format(self.limit * text.scale)
        word = "stop" if self.stop else "warning"
        return f"{state} ({word} {level})" if level else state

    def __str__(self) -> str:
        one = len(self.joints) <= 1
        verb = ("is" if one else "are") if self.stop else ("was" if one else "were")
        return f"{format_names(self.joints) or self.text.subject} {verb} {self.description}"

    def merge(self, other: "Finding") -> None:
        """Merge another finding of the same kind, from another run or a later check."""
        worse = other.value < self.value if self.text.low else other.value > self.value
        if worse:
            self.value, self.limit = other.value, other.limit
        self.joints += [name for name in other.joints if name not in self.joints]
        self.count += other.count

    def record(self) -> dict[str, Any]:
        """Return the finding as a dict for machine-readable output."""
        return {
            "kind": self.text.name,
            "joints": list(self.joints),
            "value": self.value,
            "limit": self.limit,
            "count": self.count,
            "since": self.since,
        }
