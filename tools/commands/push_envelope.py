"""`windup push --envelope`: the largest impulse survived in each direction, each way to meet it.

Survival is not monotone in the impulse: beside the largest with no fall below it stands how many
of a grid of impulses, the same for all ways, were survived.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from windup.tools.behaviours.push_edge import Edge, Search, find_edge
from windup.tools.commands.envelope_tables import largest_table, summarise, summary_table
from windup.tools.commands.plot_envelope import plot_envelope
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.parallel import run_parallel
from windup.tools.terminal.run_notes import NOTES


@dataclass(frozen=True)
class Envelope:
    """Prints a table, draws a polar plot and writes JSON.

    Attributes:
        robot: Name of the robot.
        directions: (m,) degrees.
        ways: How pushes are met.
        searches: One for each way and direction.
        jobs: Processes at a time; None: one a core.
        json: Where the result goes.
        plot: Where the picture goes.
    """

    robot: str
    directions: list[float]
    ways: Sequence[str]
    searches: list[Search]
    jobs: int | None
    json: Path | None
    plot: Path | None

    def run(self) -> int:
        """Search; returns the exit status."""
        found: dict[str, dict[float, Edge]] = {way: {} for way in self.ways}
        for search, edge in run_parallel(find_edge, self.searches, label="pushing", jobs=self.jobs):
            found[search.way][search.direction] = edge
        largest = {way: [found[way][d].impulse for d in self.directions] for way in self.ways}
        console.print(largest_table(self.directions, largest))
        summaries = {way: summarise(found[way], found) for way in self.ways}
        console.print(summary_table(summaries))
        ways = {
            way: summaries[way]
            | {"largest": largest[way], "worst": min(largest[way])}
            | {"trials": [row for edge in found[way].values() for row in (*edge.grid, *edge.rows)]}
            for way in self.ways
        }
        result = {"robot": self.robot, "directions": self.directions, "ways": ways}
        write_json(self.json, "push", result)
        if self.plot is not None:
            around = np.radians(self.directions).tolist()
            with NOTES.collecting_output_errors():
                plot_envelope(self.plot, self.robot, around, largest)
                console.print(f"picture: {self.plot}", markup=False, soft_wrap=True)
        return 0
