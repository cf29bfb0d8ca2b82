"""An IMU on a port of its own, which may be unplugged and plugged in again."""

from windup.hal.errors import PortError
from windup.hal.imu.source import ImuSource
from windup.hal.port.replug import Opener, Replug


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
