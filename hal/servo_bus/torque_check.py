"""Detects servos of a bus that have lost their torque, and withholds their goals.

A goal switches the torque of most servos on (`Family.goal_enables_torque`): after a brown-out, a
restart or a shutdown the next goal would drive the joint from wherever it hangs.
"""

import numpy as np
import numpy.typing as npt

from windup.hal.joints import Array, Mask
from windup.hal.servo_bus.bus_readout import BusReadout
from windup.hal.servo_bus.torque_cause import Suspect, find_torque_losses
from windup.hal.torque_loss import Loss

MISSES = 4
"""Consecutive missed answers after which a servo may have restarted; at 1 % loss, once in 10^8."""
SILENCE = 0.1
"""Time without a cycle after which any servo may have restarted, s: booting is assumed longer."""

PATIENCE = 3
"""Maximum number of cycles before suspects are read back; earlier if all servos answer one."""

Bits = npt.NDArray[np.uint8]


class TorqueCheck:
    """Finds the servos of one bus that have lost their torque since it was switched on.

    A servo that was silent, signals an error, or whose registers say that it has no torque is
    suspect until it has been read back: then it either still has its torque, or has lost it until
    `clear`. Suspects get no goals if a goal may switch torque on.

    Attributes:
        withheld: (servos,) bool, servos that get no goals; None if all get them.
        losses: Maps row within the bus to how the torque was lost.
        suspects: (servos,) bool, servos whose torque state is unknown.
        all_well: Whether all servos answered the last cycle, and none is suspect or without torque.
        watchdog_may_have_fired: Whether a servo answered the last cycle after a silence in which
            its Bus Watchdog may have fired.
    """

    def __init__(self, readout: BusReadout) -> None:
        self.readout = readout
        self.clear()

    def clear(self) -> None:
        """Reset: no servo is suspect or has lost its torque."""
        servos = len(self.readout.ids)
        self.withheld: Mask | None = None
        self.losses: dict[int, Loss] = {}
        self.suspects: Mask = np.zeros(servos, dtype=bool)
        self.watchdog_may_have_fired = False
        self._lost: Mask = np.zeros(servos, dtype=bool)
        self._silent: Mask = np.zeros(servos, dtype=bool)
        self._missed = np.zeros(servos, dtype=np.int64)
        self._heard: Array = np.full(servos, np.inf)
        self._bits: Bits = np.zeros(servos, dtype=np.uint8)
        self.all_well, self._then, self._waited = True, np.inf, 0
        self.readout.without_torque[:] = False

    def update(self, error: Bits, now: float, watchdog: float) -> None:
        """Evaluate the last cycle of the bus, and read back the suspects that answered it.

        Args:
            error: (n,) error bytes of all joints of the robot.
            now: Present time, s.
            watchdog: Silence after which the Bus Watchdogs fire, s; 0 if they do not run.
        """
        late = now - self._then > SILENCE
        if self.all_well and self.readout.all_well and not late:
            self._then, self.watchdog_may_have_fired = now, False
            return
        self._look(self.readout.errors(error), now, late, watchdog)
        if (ask := self.suspects & self.readout.answered).any() and self._is_time():
            self._read_back(np.flatnonzero(ask).tolist(), watchdog > 0.0)
        self._settle()

    def lose_all(self, loss: Loss) -> None:
        """Record that all servos have lost their torque."""
        self.losses = dict.fromkeys(range(len(self.readout.ids)), loss) | self.losses
        self._lost[:] = True
        self._settle()

    def _look(self, errors: Bits, now: float, late: bool, watchdog: float) -> None:
        """Mark servos suspect that were silent, newly signal an error, or read without torque."""
        answered = self.readout.answered
        if self.all_well:
            self._heard[:] = self._then
        self.watchdog_may_have_fired = watchdog > 0.0 and bool(
            (now - self._heard[answered] > 0.9 * watchdog).any()
        )
        self._heard[answered], self._then = now, now
        bits = np.where(answered, errors & self.readout.bus.family.alert, self._bits)
        self._missed = np.where(answered, 0, self._missed + 1)
        self._silent |= late | (self._missed >= MISSES)
        self.suspects |= self._silent | self.readout.without_torque | ((bits & ~self._bits) != 0)
        self.suspects &= ~self._lost
        self._bits = bits.astype(np.uint8)
        self.readout.without_torque[:] = False

    def _is_time(self) -> bool:
        """Return whether to read back now: in a cycle that all answered, or after `PATIENCE`."""
        self._waited += 1
        return self._waited >= PATIENCE or bool(self.readout.answered.all())

    def _read_back(self, rows: list[int], watched: bool) -> None:
        ids, self._waited = self.readout.ids, 0
        asked = [Suspect(ids[row], bool(self._silent[row])) for row in rows]
        found = find_torque_losses(self.readout, asked, watched)
        for row in rows:
            if ids[row] in found:
                self.suspects[row] = self._silent[row] = False
                if (loss := found[ids[row]]) is not None:
                    self.losses[row] = loss
                    self._lost[row] = True

    def _settle(self) -> None:
        self.suspects &= ~self._lost
        self._silent &= self.suspects
        wakes = self.readout.bus.family.goal_enables_torque
        withheld = self.suspects | self._lost if wakes else self._lost.copy()
        self.withheld = withheld if withheld.any() else None
        self.all_well = not (self.suspects.any() or self._lost.any() or self._missed.any())
