"""Consistency checks of a robot.toml: within itself, and against its MJCF.

Every error is one line with the file, the key and, for an unknown name, the most similar one.
"""

import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import mujoco

from windup.hal.errors import ConfigError
from windup.robots.couplings import coupling_mistakes
from windup.robots.joint_checks import joint_mistakes, name_mistakes
from windup.robots.mistake import Mistake
from windup.robots.part_checks import foot_mistakes, imu_mistakes
from windup.robots.pose_checks import pose_mistakes, stop_mistakes
from windup.robots.records import RobotFile
from windup.robots.structure import structure_mistakes


def whole_steps(rate_hz: float, timestep: float) -> int | None:
    """Return the physics steps of `timestep` s in a period of `rate_hz`; None if not whole.

    >>> whole_steps(250.0, 0.002), whole_steps(300.0, 0.002)
    (2, None)
    """
    if timestep <= 0.0:
        return None
    steps = 1.0 / (rate_hz * timestep)
    whole = round(steps)
    return whole if whole > 0 and abs(steps - whole) < 1e-6 else None


@dataclass(frozen=True)
class Checks:
    """The checks of one robot.

    Attributes:
        path: Path of its robot.toml, for messages.
        robot: The decoded robot.toml, with defaults and limits filled in.
        model: The compiled MJCF.
    """

    path: Path
    robot: RobotFile
    model: mujoco.MjModel

    def run(self) -> None:
        """Run all checks.

        Raises:
            ConfigError: A check failed; the message has the first mistake and counts the others.
        """
        found = list(dict.fromkeys(self.mistakes()))
        if found:
            key, message = found[0]
            folder = shlex.quote(str(self.path.parent))
            more = f"; {len(found) - 1} more: run `windup check {folder}`" if found[1:] else ""
            raise ConfigError(f"{self.path}: {key}: {message}{more}")

    def mistakes(self) -> Iterator[Mistake]:
        """Yield key and message of every mistake."""
        robot, model = self.robot, self.model
        rate = robot.rate_hz
        if whole_steps(rate, model.opt.timestep) is None:
            yield "rate_hz", f"a period of 1/{rate:g} s is not a whole number of physics steps"
        yield from name_mistakes(robot, model)
        yield from structure_mistakes(robot, model)
        yield from joint_mistakes(robot, model)
        yield from coupling_mistakes(robot, model)
        yield from foot_mistakes(robot, model)
        yield from imu_mistakes(robot, model)
        yield from pose_mistakes(robot)
        yield from stop_mistakes(robot)
        for key, mistake in robot.safety.mistakes(robot.drive.supply):
            yield f"safety.{key}", mistake
