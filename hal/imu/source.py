"""An IMU on a port of its own."""

from typing import Protocol

from windup.hal.observation import ImuState
from windup.hal.port.port import Port


class ImuSource(Protocol):
    """What the backend needs of an IMU that does not sit on a servo bus.

    Attributes:
        url: Its port.
        baud: Bits a second of that port.
        lag: Delay of its own low-pass filter, s.
    """

    @property
    def url(self) -> str:
        """Its port."""
        ...

    @property
    def baud(self) -> int:
        """Bits a second of that port."""
        ...

    @property
    def lag(self) -> float:
        """Delay of its own low-pass filter, s."""
        ...

    def attach(self, port: Port) -> None:
        """Listen on `port` from now on; a sample begun on another port is forgotten."""
        ...

    def poll(self) -> None:
        """Take in what has come; waits for nothing.

        Raises:
            PortError: The port went away.
        """
        ...

    def state(self, now: float) -> ImuState | None:
        """Return the last sample, aged to `now` s, or None before the first."""
        ...
