"""Inspection of a whole robot folder: robot.toml, MJCF, gaits and the other files."""

from dataclasses import dataclass
from pathlib import Path

from windup.robots.folders import FILE
from windup.robots.inspection.reading import FolderContents, read_folder
from windup.robots.inspection.robot_warnings import robot_warnings
from windup.tools.checking.assumed import assumed
from windup.tools.checking.findings import Findings
from windup.tools.checking.gait_files import check_gaits
from windup.tools.checking.other_files import check_names, check_tables


@dataclass(frozen=True)
class Inspection:
    """The result of an inspection.

    Attributes:
        folder: The folder.
        reading: The valid parts of robot.toml and MJCF.
        findings: Errors, warnings and notes.
    """

    folder: Path
    reading: FolderContents
    findings: Findings

    @property
    def name(self) -> str:
        """Name of the robot, or of the folder if robot.toml is invalid."""
        file = self.reading.file
        return self.folder.resolve().name if file is None else file.name


def inspect_folder(folder: Path) -> Inspection:
    """Return the inspection of the robot in `folder`."""
    reading, findings = read_folder(folder), Findings()
    robot = reading.robot
    findings.errors += reading.mistakes
    if not (folder / FILE).exists():
        findings.notes.append(f"`windup new robot NAME` writes a {FILE} to begin with")
    if robot is None:
        if reading.file is None or reading.model is None:
            findings.notes.append(
                f"joints, servos, feet and poses are checked once {FILE} and the MJCF can be read"
            )
        findings.notes.append(
            f"gaits are checked against joints and feet once the errors in {FILE} are gone"
        )
    else:
        findings.warnings += robot_warnings(robot)
        findings.notes += assumed(reading)
    check_gaits(folder, robot, findings)
    check_tables(folder, robot, findings)
    check_names(folder, findings)
    return Inspection(folder, reading, findings)
