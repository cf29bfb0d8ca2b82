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
from windup.hal.port.replug import RETRY, Opener, Replug
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
    off until it is read back as off, and goals are withheld until `rearmed`.

    Attributes:
        line: Readout of the servos.
        torque: Torque control of the servos.
        check: Finds servos that have lost their torque, while it should be on.
        lost: Description of the failure of the port, or None while it is open.
        losses: Number of times that the port was lost.
        heard: Time when the last answers were collected, s.
        calm: Whether the last `collect` found all servos well, so that nothing has to be handled.
        barred: Whether goals are withheld because the port was lost and `rearmed` not yet called.
    """

    def __init__(
        self, where: BusPort, opener: Opener, line: Callable[[Port], BusReadout], watchdog: float
    ) -> None:
        self._replug = Replug(where.url, where.baud, opener)
        self.line = line(self._replug.opened)
        self.torque = ServoTorque(self.line, watchdog)
        self.check = TorqueCheck(self.line)
        self._some = b"", self.line.goals
        self.lost: str | None = None
        self.losses = 0
        self.heard, self.calm = -np.inf, False
        self.barred = self._unsure = self._dropped = False
        self._look_again = 0.0
        self._goal_enables_torque = self.line.bus.family.goal_enables_torque

    @property
    def bus(self) -> Bus:
        """The bus."""
        return self.line.bus

    @property
    def clock(self) -> Clock:
        """The clock of the port, also while that is lost."""
        return self.bus.port.clock

    def request(self) -> None:
        """Request the state of all servos; reopen a lost port if it has come back."""
        if self.lost is not None or self._unsure:
            self._revive()
        if self.lost is None:
            try:
                self.line.request()
            except PortError as error:
                self._lose(error)

    def collect(self, counts: Array, health: Array, error: npt.NDArray[np.uint8]) -> Mask:
        """Return (servos,) bool: valid and plausible answers; see `BusReadout.collect`."""
        if self.lost is None:
            try:
                valid = self.line.collect(counts, health, error)
                self.heard = self.clock.now()
                if self.torque.powered:
                    watchdog = self.torque.watchdog if self.torque.armed else 0.0
                    self.check.update(error, self.heard, watchdog)
                self.calm = self.line.calm and self.check.calm and not self.check.woke
                return valid
            except PortError as gone:
                self._lose(gone)
        self.calm = False
        return np.zeros(len(self.line.ids), dtype=bool)

    def read_health(self, health: Array) -> None:
        """Read voltage and temperature of the servos into `health` (3, n), if the port is open."""
        if self.lost is None:
            try:
                self.line.read_health(health)
            except PortError as error:
                self._lose(error)

    def send_goals(self, counts: Array) -> str | None:
        """Send goals (servos,), counts, to all servos from which goals are not withheld.

        Returns the name of the clamp that withheld some, or None.
        """
        unarmed = self._goal_enables_torque and not self.torque.powered
        if self.barred or self.lost is not None or unarmed:
            return "unarmed"
        withheld = self.check.withheld
        if withheld is None:
            self.line.goals.values[:] = counts
            return None if self._send(self.line.goals.frames()) else "unarmed"
        if not withheld.all():
            goals = self._goals_but(withheld)
            goals.values[:] = counts[~withheld]
            self._send(goals.frames())
        return "lost"

    def send_gains(self, registers: Array) -> None:
        """Send P registers, (servos,)."""
        if self.barred or self.lost is not None:
            return
        for gain, rows, write in self.line.gains:
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
        self._dropped = False  # torque is switched off now, not lost
        if self.lost is None:
            try:
                return self.torque.off()
            except PortError as error:
                self._lose(error)
        return TorqueState.unread(len(self.line.ids))

    @property
    def gone_for_good(self) -> bool:
        """Whether the port is lost and this process does not reopen it."""
        return self.lost is not None and not self._replug.returns

    def insist_off(self, state: TorqueState) -> TorqueState:
        """Switch off again the servos not read back as off; first try to reopen a lost port."""
        if state.all_off:
            return state
        try:
            if self.lost is not None:
                self._replug.hurry()
                self._open(self.clock.now())
            return state if self.lost is not None else self.torque.insist(state)
        except PortError as error:
            self._lose(error)
            return state

    def clear_watchdogs(self) -> int:
        """Clear Bus Watchdogs that have fired; return their number."""
        try:
            return self.torque.revive() if self.lost is None else 0
        except PortError as error:
            self._lose(error)
            return 0

    def rearmed(self) -> None:
        """Stop withholding goals after the robot was checked and configured again."""
        self.barred = self._unsure = False
        self.check.clear()

    def close(self) -> None:
        """Close the port."""
        self._replug.close()

    def _goals_but(self, withheld: Mask) -> CyclicWrite:
        """Return the sync write of goals to all servos that are not `withheld` (servos,) bool."""
        key = withheld.tobytes()
        if self._some[0] != key:
            ids = [id for id, held in zip(self.line.ids, withheld, strict=True) if not held]
            self._some = key, self.line.goals_of(ids)
        return self._some[1]

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
        self.barred = self._unsure = True
        self._dropped |= self.torque.powered
        self.torque.armed = self.torque.powered = False
        self.line.forget()
        self._replug.lose(self.clock.now())

    def _revive(self) -> None:
        """Reopen the port, if it is back, and switch torque off until it is read back as off."""
        now = self.clock.now()
        self._open(now)
        if self.lost is None and now >= self._look_again:
            self._look_again = now + RETRY
            try:
                self._unsure = not self.torque.off(attempts=1).all_off
                self._tell_dropped()
            except PortError as error:
                self._lose(error)

    def _open(self, now: float) -> None:
        """Reopen the port if it was lost and has come back."""
        port = self._replug.again(now) if self.lost is not None else None
        if port is not None:
            self.line.bus.move_to(port)
            self.lost, self._look_again = None, now

    def _tell_dropped(self) -> None:
        """Once torque is read back as off, report that it was lost with the port."""
        if self._dropped and not self._unsure:
            self._dropped = False
            self.check.lose_all(UNPLUGGED)
