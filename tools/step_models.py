"""Where the step models of a walk come from, and where those that it learns go."""

import os
from pathlib import Path

from control.gait_hash import gait_hash
from control.learnt_models import LearntModels
from control.planner import StepPlanner
from control.regulation import RegulationVariable
from control.step_memory import Memory, memory_of
from hal.errors import UsageError
from robots import RobotDescription
from tools.gaits import gait_path
from tools.report import WalkReport
from tools.walk_options import WalkOptions
from tools.writing import check_writable, writing

SUFFIX = ".models.json"


def memory_for(
    robot: RobotDescription,
    options: WalkOptions,
    regulation: list[RegulationVariable],
    perturbations: list[str],
) -> Memory | None:
    """Return what remembers the step models of a walk; None where each is sampled.

    A library is the gait's own file of models, where it has one and they fit.

    Raises:
        ConfigError: A file of models is broken, or of other variables or another gait.
    """
    names, path = [variable.name for variable in regulation], gait_path(robot, options.gait)
    if options.learn is not None:
        learning = LearntModels()
        if os.path.exists(options.learn):
            learning.read(options.learn, names, perturbations, gait_hash(path))
        return learning
    own = path.with_suffix(SUFFIX)
    plain = options.rv is None and not options.blend
    if options.model == "library" and plain and own.exists():
        known = LearntModels(complete=True)
        known.read(own, names, perturbations, gait_hash(path))
        return known
    return memory_of(options.model)


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


def keep_learnt(path: Path, report: WalkReport) -> None:
    """Write the step models of a walk that has gone well into a file.

    Raises:
        OutputError: It cannot be written.
    """
    walker = report.walker
    planner = walker.planner
    if report.done and isinstance(planner, StepPlanner):
        assert isinstance(planner.model.memory, LearntModels), "see `memory_for`"
        names = [variable.name for variable in walker.regulation]
        gait = gait_path(report.robot.description, report.options.gait)
        with writing(path):
            planner.model.memory.write(path, names, walker.perturbations, gait_hash(gait))
