"""Where the step models go that a walk has learnt."""

from pathlib import Path

from windup.control.limit_cycle.learnt_models import LearntModels
from windup.control.limit_cycle.planner import StepPlanner
from windup.control.pose_graph.gait_hash import gait_hash
from windup.hal.errors import UsageError
from windup.tools.assembly.gaits import gait_path
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.robot.walk_report import WalkReport
from windup.tools.terminal.writing import check_writable, writing


def check_learning(options: WalkOptions, *, alone: bool) -> None:
    """Raise what cannot be.

    Raises:
        UsageError: Nothing would be learnt, several walks would at once, or the file cannot be
            written.
    """
    if options.learn is None:
        return
    if options.open_loop or options.model != "full":
        raise UsageError("--learn samples every step; leave --model and --open-loop away")
    if not alone:
        raise UsageError("--learn is for one walk without --realtime; leave it or --seeds away")
    check_writable(options.learn)


def keep_learnt(path: Path, report: WalkReport, command: str) -> None:
    """Write the step models of a walk that has gone well into a file.

    Args:
        path: The file.
        report: Of the walk.
        command: Which walk it was, as typed.

    Raises:
        OutputError: It cannot be written.
    """
    walker = report.walker
    planner = walker.planner
    if report.done and isinstance(planner, StepPlanner):
        learnt, robot = planner.model.memory, report.robot
        assert isinstance(learnt, LearntModels), "see `memory_for`"
        names = [variable.name for variable in walker.regulation]
        gait = gait_hash(gait_path(robot.description, report.options.gait))
        learnt.commands.append(command)
        file = learnt.file(names, list(walker.perturbations), gait, round(1.0 / robot.period, 6))
        with writing(path):
            path.write_text(file.text())
