"""What may be wrong with a robot when it is switched on: in its file, or in a joint."""

import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from robots import RobotDescription

Fault = Literal["sign", "swap", "jam", "motor"]
FAULTS: tuple[Fault, ...] = get_args(Fault)


@dataclass(frozen=True)
class Broken:
    """One fault.

    Attributes:
        fault: "sign": flipped in robot.toml. "swap": two ids exchanged there. "jam": a joint does
            not move. "motor": it turns the other way.
        joints: Indices of the joints that have it.
    """

    fault: Fault
    joints: tuple[int, ...]

    @classmethod
    def random(cls, robot: RobotDescription, fault: Fault, rng: np.random.Generator) -> "Broken":
        """Return the fault at random joints; ids are swapped with the other side's or the next."""
        count = len(robot.joints)
        first = int(rng.integers(count))
        if fault != "swap":
            return cls(fault, (first,))
        mirrored = int(robot.mirror.perm[first])
        other = mirrored if mirrored != first and rng.random() < 0.5 else (first + 1) % count
        return cls(fault, (first, other))

    def folder(self, robot: RobotDescription, inside: Path) -> Path:
        """Return a copy of the robot's folder whose robot.toml has the fault."""
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
    """Return a robot.toml with one thing changed in the line of a joint."""
    lines = text.splitlines(keepends=True)
    row = next(row for row, line in enumerate(lines) if f'name = "{joint}"' in line)
    lines[row] = re.sub(what, by, lines[row])
    return "".join(lines)
