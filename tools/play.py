"""`windup play`: play a pose graph on a robot."""

from contextlib import suppress
from dataclasses import dataclass
from math import inf
from typing import Annotated

import tyro

from hal.errors import UsageError
from tools.options import Common
from tools.output import console, write_json
from tools.robot import Robot


@dataclass(frozen=True, kw_only=True)
class Play(Common):
    """Play a pose graph to its end, or for some seconds."""

    graph: Annotated[str, tyro.conf.Positional]
    """Name of the graph: a file in the robot's gaits."""
    seconds: float | None = None
    """How long; to its end, or 5 s for a graph that has none."""

    def run(self) -> int:
        """Play; returns the exit status."""
        if self.seconds is not None and not 0.0 < self.seconds < inf:
            raise UsageError(f"--seconds {self.seconds:g}: give more than 0")
        rows = [self._one(seed) for seed in self.all_seeds]
        for row in rows:
            console.print(
                f"{self.robot} played {self.graph!r} for {row['sim_time_s']:.2f} s: {row['reason']}"
            )
        result = rows[0] if self.seeds is None else {"robot": self.robot, "rows": rows}
        write_json(self.json, "play", result)
        if any(row["reason"] == "interrupted" for row in rows):
            return 130
        return 1 if any(row["fell"] for row in rows) else 0

    def _one(self, seed: int) -> dict[str, object]:
        with Robot.open(
            self.robot,
            port=self.url,
            arm=self.arm,
            state=self.state,
            rate=self.rate,
            realtime=self.realtime,
            seed=seed,
            noise=self.noise,
        ) as robot:
            with suppress(KeyboardInterrupt):  # the robot has stopped
                robot.play(self.graph, self.seconds)
            report = robot.loop
            return {
                "robot": robot.description.name,
                "graph": self.graph,
                "seed": seed,
                "fell": robot.fallen,
                "reason": report.reason,
                "sim_time_s": report.sim_time,
                "wall_time_s": report.wall_time,
                "tick_ms": report.tick_ms(),
                "missed": report.missed if self.realtime else None,
            }
