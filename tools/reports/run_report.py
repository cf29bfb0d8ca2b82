"""The report of a run: why it ended, how its loop went, and its arrays if it was recorded."""

from dataclasses import dataclass, field

from windup.control.loop import LoopReport
from windup.hal.errors import UsageError
from windup.tools.reports.recording import Recording
from windup.tools.reports.run_data import Results, RunData


@dataclass
class RunReport(LoopReport, Results):
    """How a run went.

    Attributes:
        fallen: The robot had fallen at the end of the run, whether or not that ended it.
        recording: Its ticks; None if it was not recorded.
    """

    fallen: bool = False
    recording: Recording | None = field(default=None, repr=False)

    @property
    def fell(self) -> bool:
        """True if a fall ended the run."""
        return self.reason == "fell"

    @property
    def data(self) -> RunData:
        """The arrays with the names of their columns.

        Raises:
            UsageError: The run was not recorded.
        """
        if self.recording is None:
            raise UsageError(
                "this run was not recorded: open the robot with Robot.open(..., record=True)"
            )
        return self.recording.data(self.reason)
