"""Base class of all subcommands: a dataclass of options that is checked, then run."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

from windup.hal.ranges import check_numbers


@dataclass(frozen=True)
class Command(ABC):
    """Base class of all subcommands."""

    def check(self) -> None:
        """Check the options before a port is opened, a world is built, or anything moves.

        Raises:
            UsageError: A number is not finite or outside its range, or options do not fit together.
            ConfigError: The content of a named file is invalid.
        """
        check_numbers(self, "--")

    def warn(self) -> None:
        """Warn about doubtful options, after all checks and before anything moves."""
        return None

    @abstractmethod
    def run(self) -> int:
        """Execute the command; return the exit status."""
