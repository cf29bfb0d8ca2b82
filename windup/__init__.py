"""Windup: one interface to the servo buses and the MuJoCo twin of small humanoids.

    from windup import Robot

    with Robot.open("op3") as robot:
        print(robot.walk(speed=0.2, steps=40))

Nothing is imported before its name is used, so `import windup.hal` loads neither MuJoCo nor SciPy.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from windup.control.loop import LoopReport
    from windup.hal import (
        BaseState,
        Controller,
        ImuState,
        JointCommand,
        Joints,
        JointState,
        Observation,
        WindupError,
    )
    from windup.robots import RobotDescription, load_robot, robot_names
    from windup.tools.assembly.walk_options import WalkOptions
    from windup.tools.behaviours.behaviour import Behaviour
    from windup.tools.reports.play_report import PlayReport
    from windup.tools.reports.run_data import RunData, load_run
    from windup.tools.reports.run_report import RunReport
    from windup.tools.robot.robot import Robot
    from windup.tools.robot.walk_report import WalkReport

PLACES = {
    "BaseState": "windup.hal",
    "Behaviour": "windup.tools.behaviours.behaviour",
    "Controller": "windup.hal",
    "ImuState": "windup.hal",
    "JointCommand": "windup.hal",
    "JointState": "windup.hal",
    "Joints": "windup.hal",
    "LoopReport": "windup.control.loop",
    "Observation": "windup.hal",
    "PlayReport": "windup.tools.reports.play_report",
    "Robot": "windup.tools.robot.robot",
    "RobotDescription": "windup.robots",
    "RunData": "windup.tools.reports.run_data",
    "RunReport": "windup.tools.reports.run_report",
    "WalkOptions": "windup.tools.assembly.walk_options",
    "WalkReport": "windup.tools.robot.walk_report",
    "WindupError": "windup.hal",
    "load_robot": "windup.robots",
    "load_run": "windup.tools.reports.run_data",
    "robot_names": "windup.robots",
}
"""Public name to the module that has it."""

__all__ = [
    "BaseState",
    "Behaviour",
    "Controller",
    "ImuState",
    "JointCommand",
    "JointState",
    "Joints",
    "LoopReport",
    "Observation",
    "PlayReport",
    "Robot",
    "RobotDescription",
    "RunData",
    "RunReport",
    "WalkOptions",
    "WalkReport",
    "WindupError",
    "load_robot",
    "load_run",
    "robot_names",
]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for.

    Raises:
        AttributeError: There is no such name.
    """
    if name == "__version__":
        return import_module("windup.tools.command_line.version").installed_version()
    if name not in PLACES:
        raise AttributeError(f"module 'windup' has no attribute {name!r}")
    return getattr(import_module(PLACES[name]), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
