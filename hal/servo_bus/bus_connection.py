"""Connection to one bus of a robot, which survives unplugging and replugging of its port."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from windup.hal.backend import Clock
from windup.hal.bus.bus import Bus
from windup.hal.errors import PortError
from windup.hal.joints import Array, Mask
from windup.hal.port.port import Port
from windup.hal.port.port_reopener import RETRY, Opener, PortReopener
from windup.hal.protocols.cyclic import CyclicWrite
from windup.hal.servo_bus.bus_readout import BusReadout
from windup.hal.servo_bus.servo_torque import ServoTorque
from windup.hal.servo_bus.torque_check import TorqueCheck
from windup.hal.torque_loss import UNPLUGGED
from windup.hal.torque_state import TorqueState


@dataclass(frozen=True)
class BusPort:
    """The port of a bus: a URL for `open_port`, and its baud rate, bit/s."""

    url: str
    baud: int


class BusConnection:
    """The servos of a bus, their torque control and their port.

    While the port is lost, nothing raises and nothing is sent. When it is back, torque is switched
    off until it is read back as off, and goals are withheld until `end_withholding`.

    Attributes:
        readout: Readout of the servos.
        torque: Torque control of the servos.
        check: Finds servos that have lost their torque, while it should be on.
        lost: Description of the failure of the port, or None while it is open.
        losses: Number of times that the port was lost.
        answered_at: Time when the last answers were collected, s.
        all_well: Whether the last `collect` found all servos well: there is nothing to handle.
        goals_withheld: Whether the port was lost and `end_withholding` has not been called yet.
    """

    def __init__(
        self, where: BusPort, opener: Opener, readout: Callable[[Port], BusReadout], watchdog: float
    ) -> None:
        self._reopener = PortReopener(where.url, where.baud, opener)
        self.readout = readout(self._reopener.opened)
        self.torque = ServoTorque(self.readout, watchdog)
        self.check = TorqueCheck(self.readout)
        self._partial_goals = b"", self.readout.goals
        self.lost: str | None = None
        self.losses = 0
        self.answered_at, self.all_well = -np.inf, False
        self.goals_withheld = self._torque_unconfirmed = self._lost_with_port = False
        self._look_again = 0.0
        # Goals to such servos may switch torque on.
        self._goal_enables_torque = self.readout.bus.family.goal_enables_torque

    @property
    def bus(self) -> Bus:
        """The bus."""
        return self.readout.bus

    @property
    def clock(self) -> Clock:
        """The clock of the port, also while that is lost."""
        return self.bus.port.clock

    def request(self) -> None:
        """Request the state of all servos; reopen a lost port if it has come back."""
        if self.lost is not None or self._torque_unconfirmed:
            self._recover()
        if self.lost is None:
            try:
                self.readout.request()
            except PortError as error:
                self._lose(error)

    def collect(self, counts: Array, health: Array, error: npt.NDArray[np.uint8]) -> Mask:
        """Return (servos,) bool: valid and plausible answers; see `BusReadout.collect`."""
        if self.lost is None:
            try:
                valid = self.readout.collect(counts, health, error)
                self.answered_at = self.clock.now()
                if self.torque.powered:
                    watchdog = self.torque.watchdog if self.torque.armed else 0.0
                    self.check.update(error, self.answered_at, watchdog)
                self.all_well = (
                    self.readout.all_well
                    and self.check.all_well
                    and not self.check.watchdog_may_have_fired
                )
                return valid
            except PortError as gone:
                self._lose(gone)
        self.all_well = False
        return np.zeros(len(self.readout.ids), dtype=bool)

    def read_health(self, health: Array) -> None:
        """Read voltage and temperature of the servos into `health` (3, n), if the port is open."""
        if self.lost is None:
            try:
                self.readout.read_health(health)
            except PortError as error:
                self._lose(error)

    def send_goals(self, counts: Array) -> str | None:
        """Send goals (servos,), counts, to all servos from which goals are not withheld.

        Returns the name of the clamp that withheld some, or None.
        """
        if (
            self.goals_withheld
            or self.lost is not None
            or (self._goal_enables_torque and not self.torque.powered)
        ):
            return "unarmed"
        withheld = self.check.withheld
        if withheld is None:
            self.readout.goals.values[:] = counts
            return None if self._send(self.readout.goals.frames()) else "unarmed"
        if not withheld.all():
            goals = self._goals_without(withheld)
            goals.values[:] = counts[~withheld]
            self._send(goals.frames())
        return "lost"

    def send_gains(self, registers: Array) -> None:
        """Send P registers, (servos,)."""
        if self.goals_withheld or self.lost is not None:
            return
        for gain, rows, write in self.readout.gains:
            write.values[:] = gain.counts(registers[rows])
            self._send(write.frames())

    def switch_on(self, gains: Array) -> TorqueState:
        """Switch torque on at the present pose; see `ServoTorque.on`."""
        self.check.clear()
        return self.torque.on(gains)

    def send_off(self) -> None:
        """Send torque off to all servos, without waiting or reading back."""
        if self.lost is None:
            try:
                self.torque.send_off()
            except PortError as error:
                self._lose(error)

    def switch_off(self) -> TorqueState:
        """Switch torque off and return the state that was read back."""
        self._lost_with_port = False  # torque is switched off now, not lost
        if self.lost is None:
            try:
                return self.torque.off()
            except PortError as error:
                self._lose(error)
        return TorqueState.unread(len(self.readout.ids))

    @property
    def port_is_lost_for_good(self) -> bool:
        """Whether the port is lost and this process does not reopen it."""
        return self.lost is not None and not self._reopener.can_reopen

    def retry_off(self, state: TorqueState) -> TorqueState:
        """Switch off again the servos not read back as off; first try to reopen a lost port."""
        if state.all_off:
            return state
        try:
            if self.lost is not None:
                self._reopener.retry_now()
                self._open(self.clock.now())
            return state if self.lost is not None else self.torque.retry_off(state)
        except PortError as error:
            self._lose(error)
            return state

    def clear_watchdogs(self) -> int:
        """Clear Bus Watchdogs that have fired; return their number."""
        try:
            return self.torque.clear_watchdogs() if self.lost is None else 0
        except PortError as error:
            self._lose(error)
            return 0

    def end_withholding(self) -> None:
        """Stop withholding goals after the robot was checked and configured again."""
        self.goals_withheld = self._torque_unconfirmed = False
        self.check.clear()

    def close(self) -> None:
        """Close the port."""
        self._reopener.close()

    def _goals_without(self, withheld: Mask) -> CyclicWrite:
        """Return the sync write of goals to all servos that are not `withheld` (servos,) bool."""
        key = withheld.tobytes()
        if self._partial_goals[0] != key:
            ids = [id for id, held in zip(self.readout.ids, withheld, strict=True) if not held]
            self._partial_goals = key, self.readout.goals_of(ids)
        return self._partial_goals[1]

    def _send(self, frames: list[bytes]) -> bool:
        try:
            self.bus.exchange.send(frames)
        except PortError as error:
            self._lose(error)
            return False
        return True

    def _lose(self, error: PortError) -> None:
        self.lost = str(error)
        self.losses += 1
        self.goals_withheld = self._torque_unconfirmed = True
        self._lost_with_port |= self.torque.powered
        self.torque.armed = self.torque.powered = False
        self.readout.reset()
        self._reopener.lose(self.clock.now())

    def _recover(self) -> None:
        """Reopen the port, if it is back, and switch torque off until it is read back as off."""
        now = self.clock.now()
        self._open(now)
        if self.lost is None and now >= self._look_again:
            self._look_again = now + RETRY
            try:
                self._torque_unconfirmed = not self.torque.off(attempts=1).all_off
                self._report_lost_with_port()
            except PortError as error:
                self._lose(error)

    def _open(self, now: float) -> None:
        """Reopen the port if it was lost and has come back."""
        port = self._reopener.try_reopen(now) if self.lost is not None else None
        if port is not None:
            self.readout.bus.move_to(port)
            self.lost, self._look_again = None, now

    def _report_lost_with_port(self) -> None:
        """Once torque is read back as off, report that it was lost with the port."""
        if self._lost_with_port and not self._torque_unconfirmed:
            self._lost_with_port = False
            self.check.lose_all(UNPLUGGED)
