"""`windup stop`: switch the torque of a robot off, and say so only when it has been read back."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from robots import load_robot
from tools.command import Command
from tools.faults import with_faults
from tools.output import console, write_json
from tools.stack import check_port, limp


@dataclass(frozen=True, kw_only=True)
class Stop(Command):
    """Switch all torque off."""

    robot: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="ROBOT")]
    """Name of the robot, or path of its folder."""
    port: str
    """Its servo bus; see `windup walk --help`."""
    faults: str = ""
    """What goes wrong on a twin:// port: drop:0.01,unplug:at=5:seconds=1,..."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        check_port(load_robot(self.robot), self._url)

    @property
    def _url(self) -> str:
        return with_faults(self.port, self.faults) or self.port

    def run(self) -> int:
        """Stop; returns the exit status."""
        robot = load_robot(self.robot)
        on = limp(robot, self._url)
        names = [name for name, still in zip(robot.joints.names, on, strict=True) if still]
        if names:
            console.print(
                f"torque is still on, or unknown, at {', '.join(names)}; cut the servo power"
            )
        else:
            console.print(f"all {len(on)} joints of {robot.name} are limp, read back")
        write_json(
            self.json, "stop", {"robot": robot.name, "stopped": not names, "still_on": names}
        )
        return 3 if names else 0
