"""One bus of a robot as it comes and goes: its port may be unplugged and plugged in again."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hal.backend import Clock
from hal.bus import Bus
from hal.errors import HardwareError, PortError
from hal.imu.source import ImuSource
from hal.joints import Array, Mask
from hal.port import Port
from hal.replug import RETRY, Opener, Replug
from hal.servo_line import ServoLine
from hal.servo_torque import ServoTorque
from hal.torque_state import TorqueState


@dataclass(frozen=True)
class BusPort:
    """Where a bus is plugged in: a URL for `open_port`, and its bits a second."""

    url: str
    baud: int


class ServoLink:
    """A line of servos, its torque switch and its port.

    While the port is gone nothing raises and nothing is sent. When it is back, torque is switched
    off until that has been read back, and goals are withheld until `rearmed`.

    Attributes:
        line: The servos.
        torque: Their torque.
        lost: What was seen when the port went, or None while it is there.
        losses: How often it went.
        barred: Are goals withheld because the port was gone and nobody has armed the robot again?
    """

    def __init__(
        self, where: BusPort, opener: Opener, line: Callable[[Port], ServoLine], watchdog: float
    ) -> None:
        self._replug = Replug(where.url, where.baud, opener)
        self.line = line(self._replug.opened)
        self.torque = ServoTorque(self.line, watchdog)
        self.lost: str | None = None
        self.losses = 0
        self.barred = self._unsure = False
        self._look_again = 0.0
        # These may switch torque on by themselves.
        self._goal_wakes = self.line.bus.family.goal_wakes

    @property
    def bus(self) -> Bus:
        """The bus."""
        return self.line.bus

    @property
    def clock(self) -> Clock:
        """The clock of the port, also while that is gone."""
        return self.bus.port.clock

    def request(self) -> None:
        """Ask all servos; open the port again if it is gone and has come back."""
        if self.lost is not None or self._unsure:
            self._revive()
        if self.lost is None:
            try:
                self.line.request()
            except PortError as error:
                self._lose(error)

    def collect(self, counts: Array, health: Array, error: npt.NDArray[np.uint8]) -> Mask:
        """Return (servos,) bool: whose answers came; see `ServoLine.collect`."""
        if self.lost is None:
            try:
                return self.line.collect(counts, health, error)
            except PortError as gone:
                self._lose(gone)
        return np.zeros(len(self.line.ids), dtype=bool)

    def read_health(self, health: Array) -> None:
        """Read voltage and temperature of the servos into (3, n), if the port is there."""
        if self.lost is None:
            try:
                self.line.read_health(health)
            except PortError as error:
                self._lose(error)

    def send_goals(self, counts: Array) -> bool:
        """Send goals, (servos,) counts; return whether they were sent."""
        if self.barred or self.lost is not None or (self._goal_wakes and not self.torque.powered):
            return False
        self.line.goals.values[:] = counts
        return self._send(self.line.goals.frames())

    def send_gains(self, registers: Array) -> None:
        """Send P registers, (servos,)."""
        if self.barred or self.lost is not None:
            return
        for gain, rows, write in self.line.gains:
            write.values[:] = gain.counts(registers[rows])
            self._send(write.frames())

    def switch_off(self) -> TorqueState:
        """Switch torque off and return what was read back of the servos."""
        if self.lost is None:
            try:
                return self.torque.off()
            except PortError as error:
                self._lose(error)
        return TorqueState.unread(len(self.line.ids))

    def clear_watchdogs(self) -> int:
        """Clear watchdogs that have fired; return how many had."""
        try:
            return self.torque.revive() if self.lost is None else 0
        except PortError as error:
            self._lose(error)
            return 0

    def rearmed(self) -> None:
        """Let goals through again."""
        self.barred = self._unsure = False

    def close(self) -> None:
        """Give the port back."""
        self._replug.close()

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
        self.torque.armed = self.torque.powered = False
        self.line.forget()
        self._replug.lose(self.clock.now())

    def _revive(self) -> None:
        """Open the port, if it is back, and make sure that torque is off."""
        now = self.clock.now()
        if self.lost is not None:
            port = self._replug.again(now)
            if port is None:
                return
            self.line.bus.move_to(port)
            self.lost, self._look_again = None, now
        if now >= self._look_again:
            self._look_again = now + RETRY
            try:
                self._unsure = not self.torque.off(attempts=1).all_off
            except PortError as error:
                self._lose(error)
            except HardwareError:
                self._unsure = True


class ImuLink:
    """An IMU and its port, which may go and come back too."""

    def __init__(self, imu: ImuSource, opener: Opener) -> None:
        self.imu = imu
        self._replug = Replug(imu.url, imu.baud, opener)
        imu.attach(self._replug.opened)
        self.clock = self._replug.opened.clock

    def poll(self) -> None:
        """Take in what has come, if the port is there."""
        now = self.clock.now()
        if self._replug.port is None:
            port = self._replug.again(now)
            if port is None:
                return
            self.imu.attach(port)
        try:
            self.imu.poll()
        except PortError:
            self._replug.lose(now)

    def close(self) -> None:
        """Give the port back."""
        self._replug.close()
