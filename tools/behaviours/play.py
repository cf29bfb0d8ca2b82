"""Playing a pose graph."""

from dataclasses import dataclass
from typing import Annotated, Any

import tyro

from windup.control.motions.play import GraphPlayer
from windup.control.motions.staged import StagedPlayer
from windup.hal.controller import Predictor
from windup.robots import RobotDescription
from windup.tools.assembly.gaits import find_gait
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.behaviours.report import Report
from windup.tools.behaviours.run_record import RunRecord
from windup.tools.measures.load_gauge import format_load
from windup.tools.reports.play_report import PlayReport
from windup.tools.terminal.quantities import Duration


@dataclass(frozen=True, kw_only=True)
class PlayOptions:
    """Options of playing."""

    graph: Annotated[str, tyro.conf.Positional]
    """Name of the graph: a file in the robot's gaits."""
    seconds: Duration | None = None
    """How long; to its end, or 5 s for a graph that has none."""


class Play(Behaviour[PlayOptions]):
    """Play a pose graph to its end, or for some seconds."""

    name, Options, done = "play", PlayOptions, "came to the end"

    def build(
        self, robot: RobotDescription, options: PlayOptions, predictor: Predictor | None
    ) -> GraphPlayer | StagedPlayer:
        """Return what plays the graph."""
        gait = find_gait(robot, options.graph)
        kind = StagedPlayer if gait.file.staged else GraphPlayer
        return kind(gait, robot.joints, robot.contacts)

    def perform(self, run: RunRecord[PlayOptions]) -> None:
        """Go to the start pose of the graph, and play it."""
        try:
            run.robot.play(run.options.graph, run.options.seconds, disturb=run.disturb)
        finally:
            run.measured = run.robot.loop

    def report(self, run: RunRecord[PlayOptions]) -> Report:
        """Return how it played."""
        robot, loop = run.robot, run.measured
        played = loop if isinstance(loop, PlayReport) else None  # perhaps it did not come so far
        load = None if played is None else played.load
        fell = robot.fallen and not (played is not None and played.ends_down)
        result = {
            "robot": robot.description.name,
            "graph": run.options.graph,
            "seed": robot.seed,
            "done": loop.reason == "done" and not fell,
            "fell": fell,
            "reason": loop.reason,
            "retries": 0 if played is None else played.retries,
            "peak_load": None if load is None else load.peak,
            "peak_joint": "" if load is None else load.joint,
            "high_load_s": 0.0 if load is None else load.high_time,
            "sim_time_s": loop.sim_time,
            "first_motion_s": loop.first_motion,
            "wall_time_s": loop.wall_time,
            "tick_ms": loop.tick_ms(),
            "missed": loop.missed if robot.paced else None,
        }
        return Report(bool(result["done"]), loop.reason, result, (format_play(result),))


def format_play(result: dict[str, Any]) -> str:
    """Return the line for people about a graph that was played."""
    name, graph, reason = result["robot"], result["graph"], result["reason"]
    if result["sim_time_s"] <= 0.0:
        return f"{name} did not play {graph!r}: {reason}"
    again = f", {result['retries']} tried again" if result["retries"] else ""
    peak, joint = result["peak_load"], result["peak_joint"]
    worked = f"; {format_load(peak, joint)}" if joint else ""
    seconds = result["sim_time_s"] - result["first_motion_s"]
    return f"{name} played {graph!r} for {seconds:.2f} s{again}: {reason}{worked}"


PLAY = Play()
