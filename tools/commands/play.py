"""`windup play`: play a pose graph on a robot."""

from contextlib import suppress
from dataclasses import dataclass
from typing import Annotated, Any

import tyro

from windup.robots import load_robot
from windup.tools.assembly.gaits import find_gait
from windup.tools.measures.load_gauge import format_load
from windup.tools.options.common import Common
from windup.tools.options.twin_options import TwinOptions
from windup.tools.reports.play_report import PlayReport
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.quantities import Duration


@dataclass(frozen=True, kw_only=True)
class Play(TwinOptions, Common):
    """Play a pose graph to its end, or for some seconds."""

    graph: Annotated[str, tyro.conf.Positional]
    """Name of the graph: a file in the robot's gaits."""
    seconds: Duration | None = None
    """How long; to its end, or 5 s for a graph that has none."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        find_gait(load_robot(self.robot), self.graph)

    def run(self) -> int:
        """Play; returns the exit status."""
        rows = []
        for seed in self.all_seeds:
            rows.append(self._one(seed))
            console.print(self._said(rows[-1]), markup=False, soft_wrap=True)
            if rows[-1]["reason"] == "interrupted":
                break
        if self.seeds is not None:
            well = sum(row["done"] for row in rows)
            console.print(f"{well} of {len(rows)} seeds came to the end")
        result = rows[0] if self.seeds is None else {"robot": self.robot, "rows": rows}
        write_json(self.json, "play", result)
        if rows[-1]["reason"] == "interrupted":
            return 130
        return 0 if all(row["done"] for row in rows) else 1

    def _said(self, row: dict[str, Any]) -> str:
        """Return the line for people about one run."""
        if row["sim_time_s"] <= 0.0:
            return f"{row['robot']} did not play {self.graph!r}: {row['reason']}"
        again = f", {row['retries']} tried again" if row["retries"] else ""
        worked = (
            f"; {format_load(row['peak_load'], row['peak_joint'])}" if row["peak_joint"] else ""
        )
        seconds = row["sim_time_s"] - row["first_motion_s"]
        return (
            f"{row['robot']} played {self.graph!r} for {seconds:.2f} s"
            f"{again}: {row['reason']}{worked}"
        )

    def _one(self, seed: int) -> dict[str, Any]:
        with self.open_robot(
            seed,
            world=self.world(load_robot(self.robot), seed),
        ) as robot:
            with suppress(KeyboardInterrupt):  # the robot has stopped
                robot.play(self.graph, self.seconds, disturb=self.disturb())
            report = robot.loop
            played = report if isinstance(report, PlayReport) else None  # perhaps not so far
            load = None if played is None else played.load
            fell = robot.fallen and not (played is not None and played.ends_down)
            return {
                "robot": robot.description.name,
                "graph": self.graph,
                "seed": seed,
                "done": report.reason == "done" and not fell,
                "fell": fell,
                "reason": report.reason,
                "retries": 0 if played is None else played.retries,
                "peak_load": None if load is None else load.peak,
                "peak_joint": "" if load is None else load.joint,
                "high_load_s": 0.0 if load is None else load.high_time,
                "sim_time_s": report.sim_time,
                "first_motion_s": report.first_motion,
                "wall_time_s": report.wall_time,
                "tick_ms": report.tick_ms(),
                "missed": report.missed if self.realtime else None,
            }
