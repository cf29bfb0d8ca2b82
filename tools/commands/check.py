"""`windup check`: all errors and warnings about a robot folder, and a picture of the robot."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import mujoco
import tyro

from windup.robots import RobotDescription
from windup.robots.description import folder_of
from windup.tools.checking.folder import Inspection, inspect_folder
from windup.tools.checking.outline import outline_of, outline_of_model, root_of
from windup.tools.checking.picture import draw_robot
from windup.tools.checking.travel import travel_rows, travel_table
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.picture import check_picture


@dataclass(frozen=True)
class Check(Command):
    """Show all errors and warnings about a robot folder at once.

    The exit status is 2 if there are errors, and 0 if there are only warnings.
    """

    folder: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="FOLDER")]
    """A folder with your own robot, or the name of a robot of the package."""
    plot: Path | None = None
    """Draw links, joint axes, soles and centre of mass into an image file."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        folder_of(self.folder)
        check_picture(self.plot)

    def run(self) -> int:
        """Inspect the folder; returns the exit status."""
        seen = inspect_folder(folder_of(self.folder))
        _tell(seen)
        if self.plot is not None:
            self._draw(self.plot, seen)
        write_json(self.json, "check", _record(seen))
        return 2 if seen.findings.errors else 0

    def _draw(self, plot: Path, seen: Inspection) -> None:
        robot, model = seen.reading.robot, seen.reading.model
        if robot is not None:
            draw_robot(plot, f"{robot.title} in its stance", outline_of(robot))
        elif model is not None:
            title = f"{seen.name}: the MJCF in its zero pose, as robot.toml has errors"
            draw_robot(plot, title, outline_of_model(model))
        else:
            console.print("no picture: the MJCF cannot be read")
            return
        console.print(f"picture: {plot}", markup=False, soft_wrap=True)


def _tell(seen: Inspection) -> None:
    """Print the joints, the findings with the errors last, and their count."""
    if (robot := seen.reading.robot) is not None:
        console.print(travel_table(travel_rows(robot)))
    for line in seen.findings.lines():
        console.print(line, markup=False, soft_wrap=True)
    console.print(seen.findings.verdict(seen.name), markup=False, soft_wrap=True)


def _record(seen: Inspection) -> dict[str, Any]:
    """Return the result for `--json`."""
    robot, model = seen.reading.robot, seen.reading.model
    return {
        "robot": seen.name,
        "folder": str(seen.folder),
        "errors": seen.findings.errors,
        "warnings": seen.findings.warnings,
        "notes": seen.findings.notes,
        "joints": [] if robot is None else travel_rows(robot),
        "mass": None if model is None else mass_of(model, robot),
        "gaits": [] if robot is None else sorted(robot.gaits()),
    }


def mass_of(model: mujoco.MjModel, robot: RobotDescription | None) -> float:
    """Return the mass of a robot, or of the first one in a bare MJCF, kg."""
    return float(model.body_subtreemass[root_of(model, robot)])
