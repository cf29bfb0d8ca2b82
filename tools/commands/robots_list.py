"""`windup robots`: the robots that come with Windup, and their gaits."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro
from rich.table import Table

from windup.robots import load_robot, robot_names
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json


@dataclass(frozen=True)
class Robots(Command):
    """List the robots and what they can do."""

    robot: Annotated[str | None, tyro.conf.Positional, tyro.conf.arg(metavar="[ROBOT]")] = None
    """Only this one, by name or folder; `windup check FOLDER` says what is wrong with it."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def run(self) -> int:
        """List; returns the exit status."""
        names = robot_names() if self.robot is None else (self.robot,)
        robots = [load_robot(name) for name in names]
        table = Table("robot", "", "joints", "drive", "rate", "gaits", box=None)
        rows: list[dict[str, Any]] = []
        for robot in robots:
            gaits = sorted(robot.gaits())
            n, kind, rate = len(robot.joints), robot.drive.kind, robot.rate_hz
            table.add_row(robot.name, robot.title, str(n), kind, f"{rate:g} Hz", ", ".join(gaits))
            rows.append({"robot": robot.name, "title": robot.title, "joints": n, "drive": kind,
                         "rate_hz": rate, "gaits": gaits})  # fmt: skip
        console.print(table)
        write_json(self.json, "robots", {"robots": rows})
        return 0
