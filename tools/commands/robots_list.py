"""`windup robots`: the robots that come with Windup, and their gaits."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro
from rich.table import Table

from windup.robots.folders import FOLDER, robot_names
from windup.robots.summary import summarise
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
        """List the robots; return the exit status."""
        folders = [FOLDER / name for name in robot_names()]
        if self.robot is not None:
            from windup.robots import load_robot  # imports MuJoCo, which the list does not need

            folders = [load_robot(self.robot).folder]
        rows = [summarise(folder)._asdict() for folder in folders]
        console.print(_table(rows))
        write_json(self.json, "robots", {"robots": rows})
        return 0


def _table(rows: list[dict[str, Any]]) -> Table:
    """Return the table of robots for people."""
    table = Table("robot", "", "joints", "drive", "rate", "gaits", box=None)
    for row in rows:
        gaits, rate = ", ".join(row["gaits"]), f"{row['rate_hz']:g} Hz"
        table.add_row(row["robot"], row["title"], str(row["joints"]), row["drive"], rate, gaits)
    return table
