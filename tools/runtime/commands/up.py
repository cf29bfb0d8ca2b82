"""`windup up`: own a robot, hold it between two behaviours, and do what other commands want."""

from dataclasses import dataclass
from functools import partial
from typing import Annotated

import tyro

from windup.hal.errors import UsageError
from windup.robots import load_robot
from windup.robots.inspection.doubt_once import doubt_once
from windup.tools.options.faults import with_faults
from windup.tools.robot.port_urls import check_port
from windup.tools.robot.stack import State
from windup.tools.runtime.serve import serve
from windup.tools.terminal.command import Command
from windup.tools.terminal.quantities import Rate
from windup.tools.terminal.say import say


@dataclass(frozen=True, kw_only=True)
class Up(Command):
    """Own a robot until `windup down`: it is held between two behaviours, never dropped.

    Other terminals then run `windup walk ROBOT --up`, and `windup stop ROBOT` stops it.
    """

    robot: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="ROBOT")]
    """A robot's name, or the path of a folder with your own."""
    port: str | None = None
    """Servo bus; see `windup walk --help`. Without one: the twin, in real time."""
    faults: str = ""
    """What goes wrong on a twin:// port: drop:0.01,unplug:at=5:seconds=1,..."""
    arm: bool = False
    """Allow torque on a port that is not twin://: it comes on with the first command, at the
    present pose. Hold on to the robot."""
    state: State | None = None
    """Where the base state comes from; see `windup walk --help`."""
    rate: Rate | None = None
    """Rate of the control loop, Hz; the robot's own by default."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        url, robot = with_faults(self.port, self.faults), load_robot(self.robot)
        if url is not None:
            check_port(robot, url)
        elif self.arm:
            raise UsageError("--arm needs a --port; without one only the twin moves")

    def warn(self) -> None:
        """Say that something about the robot is doubtful; see `Command.warn`."""
        doubt_once(load_robot(self.robot))

    def run(self) -> int:
        """Own the robot; returns the exit status."""
        name, url = load_robot(self.robot).name, with_faults(self.port, self.faults)
        torque = "torque comes on with the first command" if self.arm else "not armed"
        where = "its twin" if url is None else f"{url}, {torque}"
        line = f"{name} on {where}: `windup down {name}` or Ctrl-C ends it"
        ready = partial(say, line)
        serve(self.robot, url, arm=self.arm, ready=ready, state=self.state, rate=self.rate)
        return 0
