"""Footprints from a file, or random ones."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import tyro

from windup.control.footprints.footprints import Footprint, read_footprints
from windup.hal.errors import UsageError
from windup.hal.ranges import Range
from windup.robots import RobotDescription
from windup.tools.behaviours.directed import build_checks, feet_of
from windup.tools.behaviours.footprint_walk import FootprintWalk


@dataclass(frozen=True, kw_only=True)
class FootprintsOptions:
    """Options of walking footprints."""

    file: Annotated[Path | None, tyro.conf.Positional, tyro.conf.arg(metavar="FILE")] = None
    """The file."""
    random: Annotated[int, Range(0, 10_000)] = 0
    """Walk so many random steps instead: any length up to 0.3 of the height of the hips forward or
    back, beside the other foot up to 0.2 of it farther than it has to be, turned up to 20
    degrees."""


class Footprints(FootprintWalk[FootprintsOptions]):
    """Walk the footprints of a file, or random ones."""

    name, Options = "footprints", FootprintsOptions

    def check(self, robot: RobotDescription, options: FootprintsOptions) -> None:
        """Check the options; see `Behaviour.check`."""
        if (options.file is None) == (options.random == 0):
            raise UsageError("give a FILE of footprints, or --random N")
        super().check(robot, options)

    def prints(
        self, robot: RobotDescription, options: FootprintsOptions, seed: int
    ) -> list[Footprint]:
        """Return the file's footprints, or random ones; see `FootprintWalk.prints`."""
        if options.file is not None:
            return read_footprints(options.file, feet_of(robot))
        return build_checks(robot).draw(options.random, np.random.default_rng(seed))


FOOTPRINTS = Footprints()
