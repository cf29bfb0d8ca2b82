"""Checks of the optional files beside robot.toml, and of misspelt file names."""

from pathlib import Path
from typing import Any, Final

from windup.control.footprints.directed_file import Directed, ServoDirected
from windup.control.stepping.step_decision import RULES
from windup.control.stepping.stepping_file import Stepping
from windup.control.stride.stride_file import Stride
from windup.control.whole_body.whole_body_file import WholeBodyFile
from windup.hal.config import read_toml
from windup.hal.errors import ConfigError, suggest
from windup.robots import RobotDescription
from windup.robots.folders import FILE, GAITS
from windup.robots.inspection.reading import decode, relative
from windup.tools.assembly.stepping import STEPPING, WAYS
from windup.tools.assembly.torques import WHOLE_BODY
from windup.tools.behaviours.directed import FOOTPRINTS
from windup.tools.behaviours.striding import FILE as STRIDE
from windup.tools.checking.findings import Findings
from windup.tools.command_line.near_word import near_word

TABLES: Final = (STEPPING, STRIDE, FOOTPRINTS, WHOLE_BODY)


def check_tables(folder: Path, robot: RobotDescription | None, findings: Findings) -> None:
    """Add the mistakes in the optional files beside robot.toml.

    Args:
        folder: The robot's folder.
        robot: The robot; None if its files are invalid: then only the keys are checked.
        findings: The findings to add to.
    """
    for name in TABLES:
        path = folder / name
        if not path.is_file() or (record := _record(name, robot)) is None:
            continue
        try:
            data = read_toml(path)
        except ConfigError as error:
            findings.errors.append(relative(folder, error))
            continue
        wrong, file = decode(name, data, record)
        findings.errors += wrong
        if file is not None and robot is not None:
            findings.errors += _names(name, file, robot)


def check_names(folder: Path, findings: Findings) -> None:
    """Add a warning for each file or folder whose name is similar to one that Windup reads."""
    read = {FILE, *TABLES, GAITS}
    for path in sorted(folder.glob("*")):
        if path.name in read or not (path.is_dir() or path.suffix in (".toml", ".tml")):
            continue
        if near := near_word(path.name, read):
            findings.warnings.append(f"{path.name}: Windup reads no such file{near}")


def _record(name: str, robot: RobotDescription | None) -> type[Any] | None:
    """Return the record of a file; None if it depends on the robot, which is invalid."""
    if name == FOOTPRINTS:
        if robot is None:
            return None
        return Directed if robot.drive.kind == "torque" else ServoDirected
    return {STEPPING: Stepping, STRIDE: Stride, WHOLE_BODY: WholeBodyFile}[name]


def _names(name: str, file: Any, robot: RobotDescription) -> list[str]:
    """Return the mistakes in the names that a file refers to."""
    found = []
    if not isinstance(file, WholeBodyFile) and file.stance not in robot.poses:
        near = suggest(file.stance, robot.poses)
        found.append(f"{name}: stance: unknown pose {file.stance!r}{near}")
    if isinstance(file, Stepping):
        if file.way not in WAYS:
            found.append(f"{name}: way: unknown way {file.way!r}{suggest(file.way, WAYS)}")
        for rule in file.rule:
            if rule not in RULES:
                found.append(f"{name}: rule.{rule}: unknown rule{suggest(rule, RULES)}")
    return found
