"""What is found in a robot's folder: one line each, which begins with the file where it has one."""

from dataclasses import dataclass, field


@dataclass
class Findings:
    """Everything that `windup check` has to say about a folder.

    Attributes:
        errors: What cannot be: a command that needs it is refused.
        doubts: What can be and is seldom meant.
        notes: What is added or assumed, and what could not be looked at.
    """

    errors: list[str] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def lines(self) -> list[str]:
        """Return all of it as people read it, the worst last."""
        return [
            *(f"note: {line}" for line in self.notes),
            *(f"warning: {line}" for line in self.doubts),
            *(f"error: {line}" for line in self.errors),
        ]

    def verdict(self, name: str) -> str:
        """Return in a few words how bad it is.

        >>> Findings(doubts=["no floor"]).verdict("rex")
        'rex: 0 errors, 1 warning'
        """
        return f"{name}: {_counted(self.errors, 'error')}, {_counted(self.doubts, 'warning')}"


def _counted(lines: list[str], what: str) -> str:
    return f"{len(lines)} {what}{'' if len(lines) == 1 else 's'}"
