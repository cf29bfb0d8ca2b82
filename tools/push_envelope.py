"""`windup push --envelope`: the largest impulse survived in each direction, each way to meet it.

Survival is not monotone in the impulse: beside the largest with no fall below it stands how many
of a grid of impulses, the same for all ways, were survived.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import takewhile
from typing import TYPE_CHECKING, Any

import numpy as np

from tools.envelope_tables import largest_table, summarise, summary_table
from tools.output import console, write_json
from tools.parallel import side_by_side
from tools.plot_envelope import plot_envelope
from tools.run_notes import NOTES

if TYPE_CHECKING:
    from tools.push import Push

COARSE, FINE = 0.4, 0.05
"""Steps of the impulse of a light robot: of the grid, and from the last success, N s."""
LIGHT = 3.0
"""Mass of a light robot, kg; heavier ones take larger steps, see `Search.scale`."""
GRID, MOST = 6, 30
"""Steps of the grid, and steps after which nothing makes it fall."""


@dataclass(frozen=True)
class Search:
    """One direction of one way.

    Attributes:
        push: The command.
        way: How the push is met.
        direction: Degrees.
        scale: Mass of the robot over that of a light one.
    """

    push: Push
    way: str
    direction: float
    scale: float

    def survives(self, impulse: float) -> dict[str, Any]:
        """Return the result of one trial."""
        push = self.push
        plan = push.plan(push.seed)
        plan = replace(plan, way=self.way, impulse=impulse, directions=(self.direction,))
        return push.one(push.seed, plan)


@dataclass
class Edge:
    """What was found in one direction.

    Attributes:
        impulse: The largest survived with none failed below it, N s.
        grid: The trials of the grid, from light to hard.
        rows: The trials between.
    """

    impulse: float
    grid: list[dict[str, Any]] = field(default_factory=list)
    rows: list[dict[str, Any]] = field(default_factory=list)


def find_edge(search: Search) -> Edge:
    """Try the whole grid, and more where nothing of it felled; then look between closely."""
    coarse = COARSE * search.scale
    edge = Edge(0.0, [search.survives(round((k + 1) * coarse, 6)) for k in range(GRID)])
    before = list(takewhile(_survived, edge.grid))
    while len(before) >= GRID and len(before) < MOST:
        edge.rows.append(search.survives(round((len(before) + 1) * coarse, 6)))
        if not _survived(edge.rows[-1]):
            break
        before.append(edge.rows[-1])
    edge.impulse = round(len(before) * coarse, 6)
    for _ in range(1, round(COARSE / FINE)):
        impulse = round(edge.impulse + FINE * search.scale, 6)
        edge.rows.append(search.survives(impulse))
        if not _survived(edge.rows[-1]):
            break
        edge.impulse = impulse
    return edge


def _survived(row: dict[str, Any]) -> bool:
    return bool(row["survived"])


class Envelope:
    """Searches all directions, prints a table, draws a polar plot and writes JSON.

    Args:
        push: The command.
    """

    def __init__(self, push: Push) -> None:
        self.push = push

    def run(self) -> int:
        """Search; returns the exit status."""
        push = self.push
        with push.open_robot(push.seed) as robot:
            scale = max(round(float(robot.twin.model.body_mass.sum()) / LIGHT), 1)
        directions = np.arange(push.directions) * 360.0 / push.directions
        searches = [Search(push, way, float(d), scale) for way in push.ways for d in directions]
        found: dict[str, dict[float, Edge]] = {way: {} for way in push.ways}
        for search, edge in side_by_side(find_edge, searches, label="pushing", jobs=push.jobs):
            found[search.way][search.direction] = edge
        largest = {way: [found[way][float(d)].impulse for d in directions] for way in push.ways}
        console.print(largest_table(directions.tolist(), largest))
        summaries = {way: summarise(found[way], found) for way in push.ways}
        console.print(summary_table(summaries))
        ways = {
            way: summaries[way]
            | {"largest": largest[way], "worst": min(largest[way])}
            | {"trials": [row for edge in found[way].values() for row in (*edge.grid, *edge.rows)]}
            for way in push.ways
        }
        result = {"robot": push.robot, "directions": directions.tolist(), "ways": ways}
        write_json(push.json, "push", result)
        if push.plot is not None:
            around = np.radians(directions).tolist()
            with NOTES.losing():
                plot_envelope(push.plot, push.robot, around, largest)
                console.print(f"picture: {push.plot}", markup=False, soft_wrap=True)
        return 0
