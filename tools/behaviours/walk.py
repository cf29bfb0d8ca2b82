"""Walking under limit-cycle balance."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from windup.control.limit_cycle.balancer import Balancer
from windup.control.stepping.supervisor import Supervisor
from windup.hal.controller import Predictor
from windup.hal.errors import UsageError
from windup.hal.geometry.up_axis import uprightness
from windup.robots import RobotDescription
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.catching import supervisor_for
from windup.tools.assembly.stepping import find_stepping
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.behaviours.report import Report, Summary
from windup.tools.behaviours.run_record import Progress, RunRecord
from windup.tools.behaviours.walk_picture import Trace, plot_walk
from windup.tools.measures.walk_text import format_summary
from windup.tools.robot.robot import Robot
from windup.tools.robot.walk_report import WalkReport, summary
from windup.tools.stopping.interrupts import RunInterruptedError
from windup.tools.terminal.quantities import Count, Delay, Seconds

STEPS = 80
GOAL_STEPS = 1000


@dataclass(frozen=True, kw_only=True)
class WalkRunOptions(WalkOptions):
    """How to walk, and for how long."""

    steps: Count | None = None
    """How many steps to walk, 80 by default; or in how many to reach a goal, 1000 by default."""
    stand: Seconds = 0.0
    """Afterwards come to rest and stand for some seconds."""
    known_ground: bool = False
    """Let the rollouts know the ground."""
    delay: Delay | None = None
    """Delay of the servos, s."""

    @property
    def how(self) -> WalkOptions:
        """How to walk, alone: it is sent to the process that plans steps."""
        return WalkOptions(**{item.name: getattr(self, item.name) for item in fields(WalkOptions)})

    @property
    def most(self) -> int:
        """Steps to walk, or to reach the goal in."""
        if self.steps is not None:
            return self.steps
        return STEPS if self.path is None and self.to is None else GOAL_STEPS


@dataclass
class Walked:
    """What is measured of a walk.

    Attributes:
        report: How it went.
        trace: Samples for the picture, if there is to be one.
    """

    report: WalkReport
    trace: Trace


class Walk(Behaviour[WalkRunOptions]):
    """Walk a robot and say how it went."""

    name, Options = "walk", WalkRunOptions
    run_parallel = plots = True

    def build(
        self, robot: RobotDescription, options: WalkRunOptions, predictor: Predictor | None
    ) -> Balancer | Supervisor:
        """Return what walks, and catches pushes where it should."""
        if options.way is not None and not options.catch:
            raise UsageError(f"--way {options.way} is how steps catch a walk: give --catch, too")
        walker = build_walk(robot, options, predictor)
        return supervisor_for(robot, walker, options) or walker

    def opening(self, robot: RobotDescription, options: WalkRunOptions) -> dict[str, Any]:
        """Return the delay of the servos, whether the rollouts know the ground, and a rate."""
        rate = {"rate": find_stepping(robot).rate} if options.catch else {}
        return {"delay": options.delay, "known_ground": options.known_ground} | rate

    def perform(self, run: RunRecord[WalkRunOptions]) -> None:
        """Walk, come to rest, and stand."""
        robot, options = run.robot, run.options
        trace = Trace(robot.description.contacts)
        if run.plot is not None:
            robot.watch.append(trace.add)
        try:
            report = robot.walk(
                steps=options.most,
                options=options.how,
                on_step=[_shown(run.progress, robot, options.most)],
                disturb=run.disturb,
                stand=options.stand,
            )
        except RunInterruptedError as stopped:
            run.measured = Walked(stopped.report, trace)
            raise
        run.measured = Walked(report, trace)

    def report(self, run: RunRecord[WalkRunOptions]) -> Report:
        """Return how it walked."""
        walked: WalkReport = run.measured.report
        return Report(walked.done, walked.loop.reason, walked.result(), (str(walked),))

    def sum_up(self, reports: Sequence[Report]) -> Summary:
        """Return what several walks have in common."""
        whole = summary([report.result for report in reports])
        return Summary(format_summary(whole), {"summary": whole})

    def draw(self, path: Path, run: RunRecord[WalkRunOptions]) -> None:
        """Draw path, regulation variables and feet on the ground; see `Behaviour.draw`."""
        plot_walk(path, run.measured.report, run.measured.trace)


def _shown(progress: Progress, robot: Robot, most: int) -> Callable[[int, float], None]:
    """Return what shows the progress at the end of a step: speed and lean."""

    def show(steps: int, speed: float) -> None:
        assert robot.base is not None, "a walk has a base state"
        _, x, y, _ = robot.base.orientation
        lean = np.degrees(np.arccos(np.clip(uprightness(x, y), -1.0, 1.0)))
        progress(steps, most, f"{speed:5.2f} m/s lean {lean:4.1f} deg")

    return show


WALK = Walk()
