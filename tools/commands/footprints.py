"""`windup footprints`: walk a file of footprints, or random ones."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import tyro

from windup.control.footprints.footprints import Footprint, read_footprints, write_footprints
from windup.hal.errors import UsageError
from windup.hal.ranges import Range
from windup.robots import load_robot
from windup.tools.behaviours.directed import build_checks, feet_of
from windup.tools.options.directed_options import DirectedOptions
from windup.tools.terminal.result import print_result


@dataclass(frozen=True, kw_only=True)
class Footprints(DirectedOptions):
    """Walk footprints: a TOML file with one [[step]] (foot, x, y, yaw, duration) after the other.

    x is forward and y to the left, m, yaw to the left, degrees, all seen from the middle of the
    sole that stays; with `frame = "start"` at the top of the file, from the middle between both
    feet at the start.
    """

    file: Annotated[Path | None, tyro.conf.Positional, tyro.conf.arg(metavar="FILE")] = None
    """The file."""
    random: Annotated[int, Range(0, 10_000)] = 0
    """Walk so many random steps instead: any length up to 0.3 of the height of the hips forward or
    back, beside the other foot up to 0.2 of it farther than it has to be, turned up to 20
    degrees."""
    write: bool = False
    """Write what would be walked to standard output, as a file; nothing moves."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        if (self.file is None) == (self.random == 0):
            raise UsageError("give a FILE of footprints, or --random N")
        super().check()

    def run(self) -> int:
        """Walk; returns the exit status."""
        if not self.write:
            return self.walk("footprints")
        robot, prints = load_robot(self.robot), self.prints(self.seed)
        build_checks(robot).check(prints)
        print_result(write_footprints(prints, feet_of(robot)))
        return 0

    def prints(self, seed: int) -> list[Footprint]:
        """Return the file's footprints, or random ones.

        Raises:
            ConfigError: The file is none.
            UsageError: It does not fit the robot.
        """
        robot = load_robot(self.robot)
        if self.file is not None:
            return read_footprints(self.file, feet_of(robot))
        return build_checks(robot).draw(self.random, np.random.default_rng(seed))
