"""Where the step models of a walk come from."""

import os

from windup.control.limit_cycle.learnt_models import LearntModels
from windup.control.limit_cycle.step_memory import Memory, memory_of
from windup.control.pose_graph.gait_hash import gait_hash
from windup.control.regulation.variables import RegulationVariable
from windup.robots import RobotDescription
from windup.tools.assembly.gaits import gait_path
from windup.tools.assembly.walk_options import WalkOptions

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
