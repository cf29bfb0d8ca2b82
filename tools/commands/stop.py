"""`windup stop`: stop the runs of a robot, or switch the torque of servos that nobody runs off.

It says that torque is off only when that has been read back.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from windup.hal.errors import UsageError
from windup.hal.joints import Mask
from windup.hal.torque_state import TorqueState
from windup.robots import RobotDescription, load_robot
from windup.tools.options.faults import with_faults
from windup.tools.robot.port_urls import check_port
from windup.tools.robot.stack import torque_off
from windup.tools.stopping.stop_runs import Stop as StopRuns
from windup.tools.stopping.stop_runs import robot_name, runs_on
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json


@dataclass(frozen=True, kw_only=True)
class Stop(Command):
    """Stop what runs a robot, from any terminal, by its stop policy; it reads the torque back."""

    robot: Annotated[str | None, tyro.conf.Positional, tyro.conf.arg(metavar="[ROBOT]")] = None
    """Name of the robot, or path of its folder."""
    all: bool = False
    """Stop everything of yours that runs on a robot, or on a twin in real time."""
    port: str | None = None
    """Switch the servos on this port off, if nothing runs the robot; see `windup walk --help`."""
    faults: str = ""
    """What goes wrong on a twin:// port: drop:0.01,unplug:at=5:seconds=1,..."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        if self.all is (self.robot is not None):
            raise UsageError("give either the ROBOT to stop, or --all")
        url = with_faults(self.port, self.faults)
        if self.robot is not None and url is not None:
            check_port(load_robot(self.robot), url)
        elif self.all and url is not None:
            raise UsageError("--port is of one robot: leave it or --all away")

    def run(self) -> int:
        """Stop; returns the exit status."""
        url = with_faults(self.port, self.faults)
        if self.robot is None or url is None or runs_on(robot_name(self.robot), url):
            return StopRuns(robot=self.robot, json=self.json).run()
        return self._switch_off(load_robot(self.robot), url)

    def _switch_off(self, robot: RobotDescription, url: str) -> int:
        """Switch off the servos on a port that nobody of ours uses; return the exit status."""
        state = torque_off(robot, url)
        console.print(_said(robot, state))
        write_json(
            self.json,
            "stop",
            {
                "robot": robot.name,
                "stopped": state.all_off,
                "still_on": _names(robot, state.on),
                "unknown": _names(robot, state.unknown),
            },
        )
        return 0 if state.all_off else 3


def _said(robot: RobotDescription, state: TorqueState) -> str:
    """Return what is known of the torque, for people."""
    joints, parts = robot.joints, []
    if state.all_off:
        return f"all {len(joints)} joints of {robot.name} are limp, read back"
    if state.on.any():
        parts.append(f"torque is still on at {state.names(joints, state.on)}")
    if state.unknown.any():
        parts.append(f"torque is unknown at {state.names(joints, state.unknown)}: no answer")
    return f"{'; '.join(parts)}; cut the servo power"


def _names(robot: RobotDescription, which: Mask) -> list[str]:
    return [name for name, there in zip(robot.joints.names, which, strict=True) if there]
