"""The encoder of a servo: horn angle to the counts that its registers show."""

from sim_twin.wire.register_file import RegisterFile
from sim_twin.wire.x_series import CENTRE, COUNTS, COUNTS_PER_RAD

REVERSE = 0x01  # bit of the drive mode


class Encoder:
    """``counts = 2048 + sign angle 4096 / (2 pi) + homing offset + whole turns``.

    Attributes:
        sign: -1 in reverse mode. It turns position, velocity, current and PWM, but not the homing
            offset.
        homing: Homing offset, counts.
        fold: Whole turns forgotten, counts.
    """

    def __init__(self) -> None:
        self.sign, self.homing, self.fold = 1.0, 0, 0

    def load(self, registers: RegisterFile) -> None:
        """Take up the registers that matter here."""
        self.sign = -1.0 if registers.get("drive_mode") & REVERSE else 1.0
        self.homing = registers.get("homing_offset")

    def counts(self, angle: float) -> int:
        """Return the counts at `angle` rad."""
        return round(CENTRE + self.sign * angle * COUNTS_PER_RAD) + self.homing + self.fold

    def angle(self, counts: float) -> float:
        """Return the angle of `counts`, rad."""
        return self.sign * (counts - CENTRE - self.homing - self.fold) / COUNTS_PER_RAD

    def forget_turns(self, angle: float) -> None:
        """Make the counts at `angle` rad lie within one turn."""
        self.fold = 0
        self.fold = -COUNTS * (self.counts(angle) // COUNTS)
