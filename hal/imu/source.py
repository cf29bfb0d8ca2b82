"""An IMU with a connection of its own, beside the servo buses."""

from typing import Protocol

from windup.hal.backend import Clock
from windup.hal.observation import ImuState
from windup.hal.port.port_reopener import Opener


class ImuConnection(Protocol):
    """An IMU's connection while it is open, which may be unplugged and plugged in again."""

    @property
    def clock(self) -> Clock:
        """The clock that it lives on."""
        ...

    def poll(self) -> None:
        """Take in what has come. Waits for no sample, and raises nothing."""
        ...

    def close(self) -> None:
        """Give the connection back."""
        ...


class ImuSource(Protocol):
    """What the backend needs of an IMU that does not sit on a servo bus.

    Attributes:
        lag: Delay of its own low-pass filter, s.
    """

    @property
    def lag(self) -> float:
        """Delay of its own low-pass filter, s."""
        ...

    def connect(self, opener: Opener) -> ImuConnection:
        """Open its connection; a serial port with `opener`.

        Raises:
            PortError: It cannot be opened, or nothing answers there.
        """
        ...

    def state(self, now: float) -> ImuState | None:
        """Return the last sample, aged to `now` s, or None before the first."""
        ...
