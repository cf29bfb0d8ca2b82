"""Whether the servos of a line still have the torque they were given; without it, no goal.

A goal switches the torque of most servos on (`Family.goal_wakes`): after a brown-out, a restart or
a shutdown the next one would drive a joint from wherever it hangs.
"""

import numpy as np
import numpy.typing as npt

from hal.joints import Mask
from hal.servo_line import ServoLine
from hal.torque_cause import Suspect, examine
from hal.torque_loss import Loss

MISSES = 4
"""Answers missed in a row after which a servo may have restarted; of 1 % losses, once in 10^8."""
SILENCE = 0.1
"""Time without a cycle after which any servo may have, s: booting takes longer (assumed)."""

Bits = npt.NDArray[np.uint8]


class TorqueCheck:
    """Finds the servos of one line that have lost their torque since it was switched on.

    A servo that was silent, signals an error, or whose registers say that it does not drive is
    suspect: it gets no goal until it has been read back. Then either it has its torque, or it
    has lost it, until `clear`.

    Attributes:
        withheld: (servos,) bool, who gets no goal; None while all do.
        losses: Row within the line to how the torque was lost.
        suspects: (servos,) bool, whose torque is unknown.
        woke: Has somebody answered the last cycle who had been silent?
    """

    def __init__(self, line: ServoLine) -> None:
        self.line = line
        self.clear()

    def clear(self) -> None:
        """Begin anew: nothing is suspect, nothing lost."""
        servos = len(self.line.ids)
        self.withheld: Mask | None = None
        self.losses: dict[int, Loss] = {}
        self.suspects: Mask = np.zeros(servos, dtype=bool)
        self._lost: Mask = np.zeros(servos, dtype=bool)
        self._silent: Mask = np.zeros(servos, dtype=bool)
        self._missed = np.zeros(servos, dtype=np.int64)
        self._bits: Bits = np.zeros(servos, dtype=np.uint8)
        self._calm, self._then = True, np.inf
        self.woke = False
        self.line.slack[:] = False

    def update(self, valid: Mask, error: Bits, now: float, watched: bool) -> bool:
        """Take in a cycle, and read back the suspects that have answered it.

        Returns whether nothing was to be seen to.

        Args:
            valid: (servos,) bool, who answered.
            error: (n,) error bytes of all joints of the robot.
            now: When, s.
            watched: Is the Bus Watchdog running, where the servos have one?
        """
        late, self._then = now - self._then > SILENCE, now
        if self._calm and self.line.calm and not late:
            self.woke = False
            return True
        self._look(valid, self.line.errors(error), late)
        self.woke = bool((self._silent & valid).any())
        if (ask := self.suspects & valid & ~self._lost).any():
            self._read_back(np.flatnonzero(ask).tolist(), watched)
        self._settle()
        return False

    def lose_all(self, loss: Loss) -> None:
        """Take down that all servos have lost their torque."""
        self.losses = dict.fromkeys(range(len(self.line.ids)), loss) | self.losses
        self._lost[:] = True
        self._settle()

    def _look(self, valid: Mask, errors: Bits, late: bool) -> None:
        """Suspect who was silent, who newly signals an error, whose torque read as off."""
        alert = np.uint8(self.line.bus.family.alert)
        bits = np.where(valid, errors & alert, self._bits)
        self._missed = np.where(valid, 0, self._missed + 1)
        self._silent |= late | (self._missed >= MISSES)
        self.suspects |= self._silent | self.line.slack | ((bits & ~self._bits) != 0)
        self._bits = bits
        self.line.slack[:] = False

    def _read_back(self, rows: list[int], watched: bool) -> None:
        ids = self.line.ids
        asked = [Suspect(ids[row], int(self._bits[row]), bool(self._silent[row])) for row in rows]
        found = examine(self.line, asked, watched)
        for row in rows:
            if ids[row] in found:
                self.suspects[row] = self._silent[row] = False
                if (loss := found[ids[row]]) is not None:
                    self.losses[row] = loss
                    self._lost[row] = True

    def _settle(self) -> None:
        self.suspects &= ~self._lost
        self._silent &= self.suspects
        withheld = self.suspects | self._lost
        self.withheld = withheld if withheld.any() else None
        self._calm = self.withheld is None and not self._missed.any()
