"""Faults of a robot when it is switched on: in its file, or in a joint."""

import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from windup.robots import RobotDescription
from windup.tools.assembly.protect import leg_joints

Fault = Literal["sign", "swap", "jam", "motor"]
FAULTS: tuple[Fault, ...] = get_args(Fault)
IN_THE_FILE: tuple[Fault, ...] = ("sign", "swap")


@dataclass(frozen=True)
class FaultyJoints:
    """One fault.

    Attributes:
        fault: "sign": inverted in robot.toml. "swap": two ids exchanged there. "jam": a joint does
            not move. "motor": a motor turns the wrong way.
        joints: Indices of the joints that have it.
    """

    fault: Fault
    joints: tuple[int, ...]

    @classmethod
    def random(
        cls, robot: RobotDescription, fault: Fault, rng: np.random.Generator
    ) -> "FaultyJoints":
        """Return the fault at random joints.

        Faults in the file concern the legs: nothing reveals where other limbs really are. Ids are
        swapped with the other side's, or with the next joint's.
        """
        joints = np.arange(len(robot.joints))
        if fault in IN_THE_FILE:
            joints = np.flatnonzero(leg_joints(robot, robot.model))
        row = int(rng.integers(len(joints)))
        first, following = int(joints[row]), int(joints[(row + 1) % len(joints)])
        if fault != "swap":
            return cls(fault, (first,))
        return cls(
            fault, (first, int(robot.mirror.perm[first]) if rng.random() < 0.5 else following)
        )

    def folder(self, robot: RobotDescription, inside: Path) -> Path:
        """Return a copy of the robot's folder with the fault in its robot.toml."""
        copy = Path(shutil.copytree(robot.folder, inside / robot.name))
        path = copy / "robot.toml"
        text = path.read_text()
        names = [robot.joints.names[joint] for joint in self.joints]
        if self.fault == "sign":
            text = _changed(text, names[0], r"(id *= *\d+)", r"sign = -1, \1")
        elif self.fault == "swap":
            ids = [mount.id for joint in self.joints if (mount := robot.servos[joint]) is not None]
            for name, id in zip(names, reversed(ids), strict=True):
                text = _changed(text, name, r"id *= *\d+", f"id = {id}")
        path.write_text(text)
        return copy


def _changed(text: str, joint: str, what: str, by: str) -> str:
    """Return the text of a robot.toml with a replacement in the line of a joint."""
    lines = text.splitlines(keepends=True)
    row = next(row for row, line in enumerate(lines) if f'name = "{joint}"' in line)
    lines[row] = re.sub(what, by, lines[row])
    return "".join(lines)
