"""One directed step."""

from dataclasses import dataclass

from windup.control.footprints.footprints import Footprint, Frame, StepRecord, footprint
from windup.robots import RobotDescription
from windup.tools.behaviours.directed import feet_of
from windup.tools.behaviours.footprint_walk import FootprintWalk
from windup.tools.terminal.quantities import Degrees, Duration, Metres


@dataclass(frozen=True, kw_only=True)
class StepOptions:
    """Options of one step."""

    foot: str
    """Which foot: left or right."""
    to: tuple[Metres, Metres]
    """Where its sole's middle should come down: X forward and Y to the left, m, seen from the
    middle of the sole that stays (the human's: from below its ankle). They stand beside each other
    at 0 0.117 (OP3, left; -0.117 right), 0 0.167 (human), 0 0.26 (human_handstand)."""
    yaw: Degrees = 0.0
    """How far it should be turned to the left, degrees, against the foot that stays."""
    duration: Duration | None = None
    """How long it is in the air, s; the robot's own by default."""
    frame: Frame = "stance"
    """What --to and --yaw are seen from: the foot that stays, or the middle between both feet."""


class Step(FootprintWalk[StepOptions]):
    """Put one foot where it is told."""

    name, Options = "step", StepOptions

    def prints(self, robot: RobotDescription, options: StepOptions, seed: int) -> list[Footprint]:
        """Return the one footprint; see `FootprintWalk.prints`."""
        x, y = options.to
        row = StepRecord(foot=options.foot, x=x, y=y, yaw=options.yaw, duration=options.duration)
        return [footprint(row, options.frame, feet_of(robot))]


STEP = Step()
