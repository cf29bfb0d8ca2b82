"""Checks of the gaits in a robot folder, and of the step models beside them."""

from pathlib import Path

from windup.control.limit_cycle.learnt_models import LearntModels
from windup.control.pose_graph.gait_file import GaitFile
from windup.control.pose_graph.gait_hash import gait_hash
from windup.control.pose_graph.gait_mistakes import gait_mistakes
from windup.control.regulation.variables import regulation_variables, unmatched
from windup.hal.config import read_toml
from windup.hal.errors import ConfigError, suggest
from windup.hal.joints import Array
from windup.robots import RobotDescription
from windup.robots.folders import GAITS, gait_files
from windup.robots.inspection.reading import decode, relative
from windup.tools.assembly.step_models import SUFFIX
from windup.tools.checking.findings import Findings


def check_gaits(folder: Path, robot: RobotDescription | None, findings: Findings) -> None:
    """Add the mistakes in the gaits of a folder and in their step models.

    Args:
        folder: The robot's folder.
        robot: The robot; None if its files are invalid: then only the keys are checked.
        findings: The findings to add to.
    """
    for path in gait_files(folder).values():
        try:
            data = read_toml(path)
        except ConfigError as error:
            findings.errors.append(relative(folder, error))
            continue
        wrong, file = decode(f"{GAITS}/{path.name}", data, GaitFile)
        findings.errors += wrong
        if robot is None or file is None:
            continue
        found = (
            _of_the_gait(path, file, robot)
            or _of_the_walk(path, file)
            or _of_the_models(path, file)
        )
        findings.errors += [line.removeprefix(f"{folder}/") for line in found]
    for models in sorted((folder / GAITS).glob(f"*{SUFFIX}")):
        gait = models.name.removesuffix(SUFFIX) + ".toml"
        if not models.with_name(gait).is_file():
            findings.warnings.append(f"{GAITS}/{models.name}: there is no gait {gait} beside it")


def _of_the_gait(path: Path, file: GaitFile, robot: RobotDescription) -> list[str]:
    """Return the mistakes of a gait for a robot."""

    def mirrored(values: Array) -> Array:
        return robot.mirror(values)  # which not every robot has

    found = gait_mistakes(path, file, robot.joints, robot.contacts, mirrored)
    if file.start is not None and file.start not in robot.poses:
        near = suggest(file.start, robot.poses)
        found.append(f"{path}: start: unknown pose {file.start!r}{near}")
    return found


def _of_the_walk(path: Path, file: GaitFile) -> list[str]:
    """Return the mistakes for which `windup walk` would refuse a gait with a `[balance]`."""
    if file.balance is None or not file.balance.regulation:
        return []
    variables = regulation_variables(file.balance.regulation)
    wrong = unmatched(file.balance.perturbations, variables)
    return [f"{path}: balance: {wrong}"] if wrong else []


def _of_the_models(path: Path, file: GaitFile) -> list[str]:
    """Return the mistakes in the step models of a gait, if it has any."""
    models, balance = path.with_suffix(SUFFIX), file.balance
    if balance is None or not models.is_file():
        return []
    names = [variable.name for variable in regulation_variables(balance.regulation)]
    try:
        LearntModels().read(models, names, balance.perturbations, gait_hash(path))
    except ConfigError as error:
        return [str(error)]
    return []
