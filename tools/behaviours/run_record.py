"""One run of a behaviour: what it is given, and what it keeps for its report."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

from windup.tools.robot.robot import Robot

T = TypeVar("T")

Progress = Callable[[int, int, str], None]
"""Called with what is done, of how much, and a note for people."""
Disturb = Callable[[Robot], None]
"""Arranges pushes on a twin, from its present time on."""


def no_progress(done: int, total: int, note: str) -> None:
    """Show nothing."""


@dataclass
class RunRecord(Generic[T]):
    """One run of a behaviour.

    Attributes:
        robot: The robot, open; nothing has moved.
        options: The options of the behaviour.
        disturb: Arranges the pushes that the user asks for; None without any.
        alone: Whether this is the only run of the command: its report may be longer then.
        plot: File into which the run will be drawn, or None.
        progress: Shows how far the run is.
        measured: What the behaviour measures for its report; filled in while it runs, so that an
            interrupted run has measured something.
    """

    robot: Robot
    options: T
    disturb: Disturb | None = None
    alone: bool = True
    plot: Path | None = None
    progress: Progress = no_progress
    measured: Any = None

    def disturb_twin(self) -> None:
        """Arrange the pushes, if any, from now on."""
        if self.disturb is not None:
            self.disturb(self.robot)
