"""The report of a pose graph that was played."""

from dataclasses import dataclass, field

from windup.control.motions.play import GraphPlayer
from windup.control.motions.staged import StagedPlayer
from windup.tools.measures.load_gauge import LoadGauge
from windup.tools.reports.run_report import RunReport


@dataclass(kw_only=True)
class PlayReport(RunReport):
    """How a pose graph went.

    Attributes:
        player: The controller that played it.
        load: How hard the servos worked.
    """

    player: GraphPlayer | StagedPlayer = field(repr=False)
    load: LoadGauge

    @property
    def retries(self) -> int:
        """How often a state was tried again."""
        return self.player.retries

    @property
    def ends_down(self) -> bool:
        """True if the graph ends with the robot on the ground."""
        return isinstance(self.player, StagedPlayer) and self.player.ends_down
