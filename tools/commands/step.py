"""`windup step`: one directed step."""

from dataclasses import dataclass

from windup.control.footprints.footprints import Footprint, Frame, StepRecord, footprint
from windup.robots import load_robot
from windup.tools.behaviours.directed import feet_of
from windup.tools.options.directed_options import DirectedOptions
from windup.tools.terminal.quantities import Degrees, Duration, Metres


@dataclass(frozen=True, kw_only=True)
class Step(DirectedOptions):
    """Put one foot where it is told: the weight goes over the other one first."""

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

    def run(self) -> int:
        """Step; returns the exit status."""
        return self.walk("step")

    def prints(self, seed: int) -> list[Footprint]:
        """Return the one footprint.

        Raises:
            UsageError: The robot has no such foot.
        """
        x, y = self.to
        row = StepRecord(foot=self.foot, x=x, y=y, yaw=self.yaw, duration=self.duration)
        return [footprint(row, self.frame, feet_of(load_robot(self.robot)))]
