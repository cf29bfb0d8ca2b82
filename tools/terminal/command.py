"""Base class of all subcommands: a dataclass of options that is checked, then run."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from windup.hal.ranges import check_numbers


@dataclass(frozen=True)
class Command(ABC):
    """Base class of all subcommands.

    Attributes:
        usage: Words behind `windup` and before `--help` that show its options; by default its name.
    """

    usage: ClassVar[str] = ""

    @classmethod
    def specialised(cls, words: Sequence[str]) -> type:
        """Return the class that the words after the command's name are parsed into.

        It is this class, but for a command whose options depend on one of the words.

        Raises:
            UsageError: The words name something that does not exist.
        """
        return cls

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
