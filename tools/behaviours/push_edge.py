"""The largest impulse that is survived in one direction, and how a grid of impulses went."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import takewhile
from typing import Any

from windup.tools.behaviours.push_trial import PushPlan

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
        push: Pushes a robot with a seed as a plan says, and returns how it went.
        seed: The seed.
        plan: The plan, but for what follows and the impulse.
        way: How the push is met.
        direction: Degrees.
        scale: Mass of the robot over that of a light one.
    """

    push: Callable[[int, PushPlan], dict[str, Any]]
    seed: int
    plan: PushPlan
    way: str
    direction: float
    scale: float

    def survives(self, impulse: float) -> dict[str, Any]:
        """Return the result of one trial."""
        plan = replace(self.plan, way=self.way, impulse=impulse, directions=(self.direction,))
        return self.push(self.seed, plan)


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
