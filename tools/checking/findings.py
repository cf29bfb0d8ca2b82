"""Findings of an inspection: errors, warnings and notes, one line each."""

from dataclasses import dataclass, field


@dataclass
class Findings:
    """The findings about one robot folder; a line begins with the file name if it is about a file.

    Attributes:
        errors: Mistakes; commands that need the file refuse it.
        warnings: Warnings: valid, but probably unintended.
        notes: Additions, defaults, and checks that were left out.
    """

    errors: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def lines(self) -> list[str]:
        """Return all lines with their kind, the errors last."""
        return [
            *(f"note: {line}" for line in self.notes),
            *(f"warning: {line}" for line in self.warnings),
            *(f"error: {line}" for line in self.errors),
        ]

    def verdict(self, name: str) -> str:
        """Return a line that counts errors and warnings.

        >>> Findings(warnings=["no floor"]).verdict("rex")
        'rex: 0 errors, 1 warning'
        """
        return f"{name}: {_counted(self.errors, 'error')}, {_counted(self.warnings, 'warning')}"


def _counted(lines: list[str], what: str) -> str:
    return f"{len(lines)} {what}{'' if len(lines) == 1 else 's'}"
