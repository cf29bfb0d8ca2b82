"""An IMU that sends on a serial port of its own, which may be unplugged and plugged in again."""

from typing import Protocol

from windup.hal.errors import PortError
from windup.hal.port.port import Port
from windup.hal.port.port_reopener import Opener, PortReopener


class SerialImu(Protocol):
    """What a `SerialLink` needs of an IMU.

    Attributes:
        url: Its port.
        baud: Bits a second of that port.
    """

    @property
    def url(self) -> str:
        """Its port."""
        ...

    @property
    def baud(self) -> int:
        """Bits a second of that port."""
        ...

    def attach(self, port: Port) -> None:
        """Listen on `port` from now on; a sample begun on another port is forgotten."""
        ...

    def poll(self) -> None:
        """Take in what has come; waits for nothing.

        Raises:
            PortError: The port was disconnected.
        """
        ...


class SerialLink:
    """An IMU and its port, which may go and come back; an `ImuConnection`."""

    def __init__(self, imu: SerialImu, opener: Opener) -> None:
        self.imu = imu
        self._reopener = PortReopener(imu.url, imu.baud, opener)
        imu.attach(self._reopener.opened)
        self.clock = self._reopener.opened.clock

    def poll(self) -> None:
        """Take in what has come, if the port is there."""
        now = self.clock.now()
        if self._reopener.port is None:
            port = self._reopener.try_reopen(now)
            if port is None:
                return
            self.imu.attach(port)
        try:
            self.imu.poll()
        except PortError:
            self._reopener.lose(now)

    def close(self) -> None:
        """Give the port back."""
        self._reopener.close()
