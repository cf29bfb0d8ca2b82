"""How a run of a behaviour went, and how several did."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

from windup.hal.guard.clamp_text import clamp_text
from windup.tools.robot.robot import Robot
from windup.tools.robot.stopping import INTERRUPTED

PLAIN: Final = (bool, int, float, str, tuple, list)
"""Types that JSON has."""


@dataclass(frozen=True)
class Report:
    """How a run went.

    Attributes:
        good: Whether the robot did what was asked; the exit status is 0 then.
        reason: Why the run ended.
        result: The numbers in plain data, with the keys of the JSON.
        lines: The text for people, a line each.
    """

    good: bool
    reason: str
    result: dict[str, Any]
    lines: tuple[str, ...]

    def __str__(self) -> str:
        return "\n".join(self.lines)

    def interrupted(self) -> "Report":
        """Return the report of a run that somebody interrupted, between two runs of the loop too.

        Otherwise its reason would be that of the last run of the loop.
        """
        if self.reason == INTERRUPTED:
            return self
        result = self.result | {"reason": INTERRUPTED}
        return replace(self, good=False, reason=INTERRUPTED, result=result)


@dataclass(frozen=True)
class Summary:
    """How the runs of several seeds went.

    Attributes:
        text: The line for people.
        result: Keys of the JSON beside its `rows`.
    """

    text: str
    result: dict[str, Any] = field(default_factory=dict)


def count_good(reports: Sequence[Report], done: str) -> Summary:
    """Return how many seeds went well, such as "3 of 4 seeds stood" where `done` is "stood"."""
    good = sum(report.good for report in reports)
    return Summary(f"{good} of {len(reports)} seeds {done}")


def _plain(value: Any) -> Any:
    """Return an option as JSON may have it; a path or a member of an enumeration is text."""
    return (
        value if isinstance(value, bool | int | float | str | tuple | list | None) else str(value)
    )


def usual_report(name: str, robot: Robot, options: dict[str, Any]) -> Report:
    """Return how the last run of a robot went; it is good if it was not broken off by a fall.

    Args:
        name: Name of what ran.
        robot: The robot.
        options: Its options by name, for the result.
    """
    loop, fell = robot.loop, robot.fallen
    result = {
        "robot": robot.description.name,
        "behaviour": name,
        "options": {key: _plain(value) for key, value in options.items()},
        "seed": robot.seed,
        "fell": fell,
        "reason": loop.reason,
        "sim_time_s": loop.sim_time,
        "first_motion_s": loop.first_motion,
        "wall_time_s": loop.wall_time,
        "tick_ms": loop.tick_ms(),
        "missed": loop.missed if robot.paced else None,
        "clamps": {clamp: count for clamp, count in robot.backend.clamps.items() if count},
    }
    seconds = loop.sim_time - loop.first_motion
    line = f"{robot.description.name} ran {name} for {seconds:.2f} s: {loop.reason}"
    if clipped := clamp_text(robot.backend):
        line += f"; {clipped}"
    return Report(loop.reason == "done" and not fell, loop.reason, result, (line,))
