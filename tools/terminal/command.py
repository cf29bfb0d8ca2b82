"""What every subcommand is: a dataclass of options that is checked, then run."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

from windup.hal.ranges import check_numbers


@dataclass(frozen=True)
class Command(ABC):
    """The base of every subcommand."""

    def check(self) -> None:
        """Raise what cannot be, before a port is opened, a world is built, or anything moves.

        Raises:
            UsageError: A number is not finite or outside its range, or options do not fit.
            ConfigError: A file that is named says something that cannot be.
        """
        check_numbers(self, "--")

    def warn(self) -> None:
        """Say what is doubtful, once all is checked and before anything moves."""
        return None

    @abstractmethod
    def run(self) -> int:
        """Do it; returns the exit status."""
