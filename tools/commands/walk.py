"""`windup walk`: walk a robot under limit-cycle balance."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from windup.tools.behaviours.run_record import RunRecord
from windup.tools.behaviours.walk import WALK, WalkRunOptions
from windup.tools.command_line.typed import as_typed
from windup.tools.commands.behaviour_command import BehaviourCommand
from windup.tools.options.twin_options import TwinOptions
from windup.tools.robot.learnt_file import check_learning, keep_learnt
from windup.tools.terminal.run_notes import NOTES


@dataclass(frozen=True, kw_only=True)
class Walk(WalkRunOptions, TwinOptions, BehaviourCommand):
    """Walk a robot and say how it went."""

    behaviour = WALK
    plot: Path | None = None
    """Draw the walk into an image file: path, regulation variables, feet on the ground."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        check_learning(self, alone=self.seeds is None and not self.realtime)

    def keep(self, run: RunRecord[Any]) -> None:
        """Write the step models that were learnt, and the picture."""
        if self.learn is not None:
            with NOTES.collecting_output_errors():
                line = as_typed(self, ("learn", "json", "plot"))
                keep_learnt(self.learn, run.measured.report, line)
        super().keep(run)
