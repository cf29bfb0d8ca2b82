"""`windup robots`: the robots of Windup and of other distributions, and their gaits."""

import logging
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro
from rich.table import Table

from windup.hal.errors import ConfigError
from windup.robots.folders import FOLDER, robot_folders
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
        if self.robot is None:
            rows = _rows()
        else:
            from windup.robots import load_robot  # imports MuJoCo, which the list does not need

            rows = [summarise(load_robot(self.robot).folder)._asdict()]
        console.print(_table(rows))
        write_json(self.json, "robots", {"robots": rows})
        return 0


def _rows() -> list[dict[str, Any]]:
    """Return the row of each robot; one of another distribution that is broken is reported."""
    rows = []
    for name, folder in robot_folders().items():
        try:
            rows.append(summarise(folder)._asdict() | {"robot": name})
        except ConfigError as error:
            if folder == FOLDER / name:
                raise
            logging.getLogger(__name__).warning("%s", error)
    return rows


def _table(rows: list[dict[str, Any]]) -> Table:
    """Return the table of robots for people."""
    table = Table("robot", "", "joints", "drive", "rate", "gaits", box=None)
    for row in rows:
        gaits, rate = ", ".join(row["gaits"]), f"{row['rate_hz']:g} Hz"
        table.add_row(row["robot"], row["title"], str(row["joints"]), row["drive"], rate, gaits)
    return table
