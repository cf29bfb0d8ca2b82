"""`windup new`: writes an example robot, gait or controller."""

import shlex
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, Literal

import tyro

from windup.robots import load_robot, robot_names
from windup.tools.scaffold.examples import (
    GAIT,
    Files,
    controller_files,
    gait_files,
    robot_files,
)
from windup.tools.scaffold.places import (
    check_new,
    controller_place,
    gait_place,
    robot_place,
    write_new,
)
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json


@dataclass(frozen=True)
class New(Command):
    """Write a small working example: a robot, a gait or a controller.

    The robot is a folder; it has two legs, stands and squats. Gait and controller move one joint of
    a robot that stands. No file is ever overwritten.
    """

    kind: Annotated[Literal["robot", "gait", "controller"], tyro.conf.Positional]
    """What to write."""
    name: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="NAME")]
    """Its name, or its path FOLDER/NAME."""
    robot: str = "op3"
    """The robot of a gait or a controller, by name or folder; a gait goes into the
    folder of a robot of your own, else into the present one."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        check_new(self._files)

    def run(self) -> int:
        """Write the files; returns the exit status."""
        write_new(self._files)
        steps = self._steps()
        for path in self._files:
            console.print(f"wrote {path}", markup=False, soft_wrap=True)
        for step in steps:
            console.print(f"next: {step}", markup=False, soft_wrap=True)
        write_json(self.json, "new", {"files": [str(path) for path in self._files], "next": steps})
        return 0

    @cached_property
    def _files(self) -> Files:
        """The files and their texts."""
        if self.kind == "robot":
            return robot_files(robot_place(self.name))
        robot = load_robot(self.robot)
        if self.kind == "gait":
            return gait_files(gait_place(self.name, self.robot), robot)
        return controller_files(controller_place(self.name), self.robot, robot)

    def _steps(self) -> list[str]:
        """Return the commands to run next."""
        path = next(iter(self._files))
        if self.kind == "controller":
            return [shlex.join(["windup", "run", self.robot, str(path)])]
        if self.kind == "gait":
            inside = self.robot not in robot_names() and path.parent.parent == Path(self.robot)
            gait = path.stem if inside else str(path)
            return [shlex.join(["windup", "play", self.robot, gait])]
        folder = path.parent
        url = f"twin://{folder if folder.is_absolute() else f'./{folder}'}"
        lines = [
            ["check", str(folder), "--plot", f"{folder.name}.png"],
            ["stand", str(folder)],
            ["play", str(folder), GAIT],
            ["stand", str(folder), "--port", url],
        ]
        return [shlex.join(["windup", *line]) for line in lines]
