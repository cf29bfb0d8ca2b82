"""`windup footprints`: walk a file of footprints, or random ones."""

from dataclasses import dataclass

from windup.control.footprints.footprints import write_footprints
from windup.robots import load_robot
from windup.tools.behaviours.directed import build_checks, feet_of
from windup.tools.behaviours.footprints import FOOTPRINTS, FootprintsOptions
from windup.tools.commands.behaviour_command import BehaviourCommand
from windup.tools.options.twin_options import TwinOptions
from windup.tools.terminal.result import print_result


@dataclass(frozen=True, kw_only=True)
class Footprints(FootprintsOptions, TwinOptions, BehaviourCommand):
    """Walk footprints: a TOML file with one [[step]] (foot, x, y, yaw, duration) after the other.

    x is forward and y to the left, m, yaw to the left, degrees, all seen from the middle of the
    sole that stays; with `frame = "start"` at the top of the file, from the middle between both
    feet at the start.
    """

    behaviour = FOOTPRINTS
    write: bool = False
    """Write what would be walked to standard output, as a file; nothing moves."""

    def run(self) -> int:
        """Walk; returns the exit status."""
        if not self.write:
            return super().run()
        robot = load_robot(self.robot)
        prints = FOOTPRINTS.prints(robot, self.options, self.seed)
        build_checks(robot).check(prints)
        print_result(write_footprints(prints, feet_of(robot)))
        return 0
