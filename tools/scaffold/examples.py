"""Texts of the examples, by file."""

import json
import shlex
from math import degrees, radians
from pathlib import Path
from typing import Final

from windup.hal.joints import Joint
from windup.robots import RobotDescription, robot_names
from windup.robots.folders import FILE, GAITS
from windup.tools.scaffold.joint_choice import harmless_swing
from windup.tools.schemas.files import schema_line

HERE: Final = Path(__file__).parent
CONTROLLER: Final = "my_controller.py"
GAIT: Final = "squat"

Files = dict[Path, str]
"""Path of a file, and its text."""


def robot_files(folder: Path) -> Files:
    """Return the files of a robot with two legs, named as its folder."""
    read = {path.name: path.read_text(encoding="utf-8") for path in (HERE / "robot").iterdir()}
    named = {name: text.replace("NAME", folder.name) for name, text in read.items()}
    return {
        folder / FILE: f"{schema_line('robot')}\n{named[FILE]}",
        folder / "model.xml": named["model.xml"],
        folder / GAITS / f"{GAIT}.toml": f"{schema_line('gait')}\n{named[f'{GAIT}.toml']}",
    }


def gait_files(path: Path, robot: RobotDescription) -> Files:
    """Return the file of a pose graph that moves one joint of a robot there and back."""
    swing = harmless_swing(robot)
    stance = next(name for name, pose in robot.poses.items() if pose is robot.stance)
    pose = "".join(
        f"{joint.name} = {_degrees(joint, float(angle))}\n"
        for joint, angle in zip(robot.joints.joints, robot.stance, strict=True)
        if angle
    )
    text = f"""{schema_line("gait")}
# A pose graph for {robot.name}. Degrees and seconds. The pose of a state is added to [pose];
# `move` is how long the goals glide there.
title = "Moves {swing.joint} there and back"
start = "{stance}"
loop = false             # true: from the last state to the first one again

[pose]                   # the pose {stance}, in degrees
{pose}
[[state]]
name = "ready"
until = {{ time = 0.5 }}

[[state]]
name = "there"
pose = {{ {swing.joint} = {swing.degrees:g} }}
move = 0.8
until = {{ time = 1.0 }}

[[state]]
name = "back"
move = 0.8
until = {{ time = 1.0 }}
"""
    return {path: text}


def controller_files(path: Path, name: str, robot: RobotDescription) -> Files:
    """Return the file of a controller that moves one joint of a robot to and fro.

    Args:
        path: Its file.
        name: Name of the robot, or path of its folder, as given by the user.
        robot: The robot.
    """
    swing = harmless_swing(robot)
    kind = "".join(word.capitalize() for word in path.stem.split("_"))
    kind = kind if kind.endswith("Controller") else f"{kind}Controller"
    text = (HERE / CONTROLLER).read_text(encoding="utf-8")
    given = shlex.quote(name)
    of_ours = name in robot_names() or Path(name).is_absolute()
    url = shlex.quote(f"twin://{name}" if of_ours else f"twin://./{name}")
    changes = {
        "run op3": f"run {given}",
        "--port twin://op3": f"--port {url}",
        '"head_pan"': json.dumps(swing.joint),
        "degrees: float = 15.0": f"degrees: float = {swing.degrees}",
        CONTROLLER: path.name,
        "MyController": kind,
    }
    for old, new in changes.items():
        text = text.replace(old, new)
    return {path: text}


def _degrees(joint: Joint, angle: float) -> str:
    """Return an angle in degrees, rounded unless that is outside the joint limits."""
    exact = degrees(angle)
    rounded = round(exact, 2)
    inside = joint.lower <= radians(rounded) <= joint.upper
    return f"{rounded:g}" if inside else repr(exact)
