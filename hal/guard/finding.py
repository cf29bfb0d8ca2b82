"""What a watch has found: who is unwell, of what, how badly. One finding a cause."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from windup.hal.guard.levels import Kind

FEW = 3
"""So many joints are named; more are counted."""


CHECK, AGAIN = "check its cable and power", "switch it off and on"
"""What to do about a part that is silent, and about one that says what is wrong."""


class Saying(NamedTuple):
    """How a kind of finding is put into words.

    Attributes:
        name: The kind, for programs.
        state: What the joints are, with their worst value.
        level: The limit.
        do: What to do about it.
        scale: From the value to what is printed.
        who: Who has it where it is no joint.
        low: Is less worse?
    """

    name: str
    state: str
    level: str
    do: str
    scale: float = 1.0
    who: str = ""
    low: bool = False


SAYINGS = {
    Kind.SUPPLY_LOW: Saying(
        "supply low", "on {:.1f} V", "below {:.1f}", "charge the battery, or check its connector",
        low=True,
    ),
    Kind.SUPPLY_HIGH: Saying(
        "supply high", "on {:.1f} V", "above {:.1f}", "switch the power off: it is the wrong supply"
    ),
    Kind.TEMPERATURE: Saying(
        "temperature", "at {:.0f} degrees C", "at {:.0f}",
        "let it cool; a pose with less load helps",
    ),
    Kind.LOAD: Saying(
        "load", "at {:.0f} % of stall torque for a second", "at {:.0f} %",
        "take a pose with less load, or carry less", 100.0,
    ),
    Kind.STALL: Saying(
        "stall", "blocked at full torque for {:.1f} s", "at {:.1f} s", "free what holds it"
    ),
}  # fmt: skip


def named(joints: Iterable[str]) -> str:
    """Return a few names, or how many there are.

    >>> named(["l_knee", "r_knee"]), named("abcd")
    ('l_knee and r_knee', '4 joints')
    """
    names = list(joints)
    if len(names) > FEW:
        return f"{len(names)} joints"
    return " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


@dataclass
class Finding:
    """One cause for a warning or a stop, over all joints that had it.

    Attributes:
        saying: What is wrong, in words.
        value: The worst value.
        limit: The level that was passed, at the joint with the worst value.
        since: When it was first seen, s on the backend's clock.
        stop: Is it a reason to stop?
        joints: Who had it.
        count: How often one of them began to.
    """

    saying: Saying
    value: float
    limit: float
    since: float
    stop: bool = False
    joints: list[str] = field(default_factory=list)
    count: int = 0

    @property
    def what(self) -> str:
        """What those who have it are, or were, and the level."""
        saying = self.saying
        state = saying.state.format(self.value * saying.scale)
        level = saying.level.format(self.limit * saying.scale)
        word = "stop" if self.stop else "warning"
        return f"{state} ({word} {level})" if level else state

    def __str__(self) -> str:
        one = len(self.joints) <= 1
        verb = ("is" if one else "are") if self.stop else ("was" if one else "were")
        return f"{named(self.joints) or self.saying.who} {verb} {self.what}"

    def merge(self, other: "Finding") -> None:
        """Take in another finding of the same kind, of another run or a later look."""
        worse = other.value < self.value if self.saying.low else other.value > self.value
        if worse:
            self.value, self.limit = other.value, other.limit
        self.joints += [name for name in other.joints if name not in self.joints]
        self.count += other.count

    def record(self) -> dict[str, Any]:
        """Return it for programs."""
        return {
            "kind": self.saying.name,
            "joints": list(self.joints),
            "value": self.value,
            "limit": self.limit,
            "count": self.count,
            "since": self.since,
        }
