"""`windup push --envelope`: the largest impulse survived in each direction, each way to meet it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.table import Table

from tools.output import console, write_json
from tools.parallel import side_by_side
from tools.plot_envelope import plot_envelope

if TYPE_CHECKING:
    from tools.push import Push

COARSE, FINE = 0.2, 0.05
"""Steps of the impulse of a light robot: up to the first fall, and from the last success, N s."""
LIGHT = 3.0
"""Mass of a light robot, kg; heavier ones take larger steps, see `Search.scale`."""
MOST = 30
"""Coarse steps after which nothing makes it fall."""


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
        rows: All trials.
    """

    impulse: float
    rows: list[dict[str, Any]] = field(default_factory=list)


def find_edge(search: Search) -> Edge:
    """Go up in coarse steps to the first fall, then in fine ones from the last success."""
    edge = Edge(0.0)
    for step in (COARSE * search.scale, FINE * search.scale):
        for _ in range(MOST):
            impulse = round(edge.impulse + step, 6)
            edge.rows.append(search.survives(impulse))
            if not edge.rows[-1]["survived"]:
                break
            edge.impulse = impulse
    return edge


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
        table = {way: [found[way][float(d)].impulse for d in directions] for way in push.ways}
        console.print(_table(directions.tolist(), table))
        write_json(push.json, "push", _record(push, directions.tolist(), found))
        if push.plot is not None:
            plot_envelope(Path(push.plot), push.robot, np.radians(directions).tolist(), table)
            console.print(f"picture: {push.plot}")
        return 0


def _table(directions: list[float], found: dict[str, list[float]]) -> Table:
    table = Table(title="largest impulse survived, N s")
    for name in ("way", *(f"{direction:g}" for direction in directions), "worst", "mean"):
        table.add_column(name, justify="left" if name == "way" else "right")
    for way, row in found.items():
        ends = (min(row), float(np.mean(row)))
        table.add_row(way, *(f"{value:.2f}" for value in (*row, *ends)))
    return table


def _record(
    push: Push, directions: list[float], found: dict[str, dict[float, Edge]]
) -> dict[str, Any]:
    ways = {
        way: {
            "largest": [edges[d].impulse for d in directions],
            "worst": min(edges[d].impulse for d in directions),
            "mean": float(np.mean([edges[d].impulse for d in directions])),
            "trials": [row for d in directions for row in edges[d].rows],
        }
        for way, edges in found.items()
    }
    return {"robot": push.robot, "directions": directions, "ways": ways}
