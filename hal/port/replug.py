"""A port that was unplugged is opened again when it is back."""

from collections.abc import Callable

from windup.hal.errors import PortError, UsageError
from windup.hal.port.network_port import NETWORK
from windup.hal.port.open_port import stable_url
from windup.hal.port.port import Port

RETRY = 0.25
"""Time between two attempts, s."""

Opener = Callable[[str, int], Port]


class Replug:
    """Opens one port as often as it takes, never more than one at a time.

    A device is looked for by the serial number it had, since its path may change; a board that
    has none, by its path.

    Args:
        url: What was opened first.
        baud: Bits a second.
        opener: Opens a port.

    Attributes:
        opened: The port that was opened last.
        port: The same, or None while it is gone.
    """

    def __init__(self, url: str, baud: int, opener: Opener) -> None:
        self._baud, self._opener = baud, opener
        self.opened = opener(url, baud)
        self.port: Port | None = self.opened
        self._url = stable_url(self.opened.place)
        self._next = 0.0

    @property
    def returns(self) -> bool:
        """False for a network: connecting may take seconds, in which a loop would stand still."""
        return not self._url.startswith(NETWORK)

    def lose(self, now: float) -> None:
        """Close the port, which has failed."""
        self.close()
        self._next = now + RETRY

    def hurry(self) -> None:
        """Try at the next moment: somebody waits."""
        self._next = 0.0

    def again(self, now: float) -> Port | None:
        """Return the port opened anew, or None if it is not back or was tried a moment ago.

        A port that does not return is not tried.
        """
        if now < self._next or not self.returns:
            return None
        self._next = now + RETRY
        try:
            self.opened = self._opener(self._url, self._baud)
        except (PortError, UsageError):
            return None
        self.port = self.opened
        return self.port

    def close(self) -> None:
        """Give the port back, if it is open."""
        port, self.port = self.port, None
        if port is not None:
            port.close()
