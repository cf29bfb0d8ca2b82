"""`windup stop`: switch the torque of a robot off, and say so only when it has been read back."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from windup.hal.joints import Mask
from windup.hal.torque_state import TorqueState
from windup.robots import RobotDescription, load_robot
from windup.tools.options.faults import with_faults
from windup.tools.robot.port_urls import check_port
from windup.tools.robot.stack import torque_off
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json


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
        state = torque_off(robot, self._url)
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
