"""`windup down`: end the runtime of a robot."""

from dataclasses import dataclass
from typing import Annotated

import tyro

from windup.tools.remote.client import RuntimeClient
from windup.tools.stopping.stop_runs import robot_name
from windup.tools.terminal.command import Command
from windup.tools.terminal.say import say


@dataclass(frozen=True, kw_only=True)
class Down(Command):
    """End the runtime of a robot: what it does ends, it rests, and its torque goes off."""

    robot: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="ROBOT")]
    """Name of the robot, or path of its folder."""

    def run(self) -> int:
        """End the runtime; returns the exit status.

        Raises:
            UsageError: The robot is not up.
            HardwareError: It does not end.
        """
        name = robot_name(self.robot)
        with RuntimeClient(name, "windup down") as client:
            client.down()
        say(f"{name} is down")
        return 0
