"""What a watch has found: who is unwell, of what, how badly. One finding a cause."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from hal.guard.levels import Kind

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
    """

    name: str
    state: str
    level: str
    do: str
    scale: float = 1.0
    who: str = ""


SAYINGS = {
    Kind.SUPPLY_LOW: Saying(
        "supply", "on {:.1f} V", "below {:.1f}", "charge the battery, or check its connector"
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

    def __str__(self) -> str:
        saying = self.saying
        state = saying.state.format(self.value * saying.scale)
        level = saying.level.format(self.limit * saying.scale)
        one = len(self.joints) <= 1
        verb = ("is" if one else "are") if self.stop else ("was" if one else "were")
        word = "stop" if self.stop else "warning"
        limit = f" ({word} {level})" if level else ""
        return f"{named(self.joints) or saying.who} {verb} {state}{limit}"

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
