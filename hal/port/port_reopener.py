"""Reopens a port after its adapter was unplugged and plugged in again."""

from collections.abc import Callable

from windup.hal.errors import PortError, UsageError
from windup.hal.port.network_port import NETWORK
from windup.hal.port.open_port import stable_url
from windup.hal.port.port import Port

RETRY = 0.25
"""Time between two attempts, s."""

Opener = Callable[[str, int], Port]


class PortReopener:
    """Opens one port, and reopens it after each loss; at most one port is open at a time.

    A device is found again by its serial number, since its path may change; a device without a
    serial number, by its path.

    Args:
        url: URL to open first.
        baud: Baud rate, bit/s.
        opener: Opens a port.

    Attributes:
        opened: The port that was opened last.
        port: The same, or None while the port is lost or closed.
    """

    def __init__(self, url: str, baud: int, opener: Opener) -> None:
        self._baud, self._opener = baud, opener
        self.opened = opener(url, baud)
        self.port: Port | None = self.opened
        self._url = stable_url(self.opened.absolute_url)
        self._next = 0.0

    @property
    def can_reopen(self) -> bool:
        """Whether it is reopened; False for a network: connecting may block a loop for seconds."""
        return not self._url.startswith(NETWORK)

    def lose(self, now: float) -> None:
        """Close the port after a failure, and schedule the first attempt to reopen it."""
        self.close()
        self._next = now + RETRY

    def retry_now(self) -> None:
        """Allow the next attempt at once, without waiting for `RETRY`."""
        self._next = 0.0

    def try_reopen(self, now: float) -> Port | None:
        """Reopen and return the port; None if it is missing or was tried less than `RETRY` ago.

        Network ports are not tried (see `can_reopen`).
        """
        if now < self._next or not self.can_reopen:
            return None
        self._next = now + RETRY
        try:
            self.opened = self._opener(self._url, self._baud)
        except (PortError, UsageError):
            return None
        self.port = self.opened
        return self.port

    def close(self) -> None:
        """Close the port, if it is open."""
        port, self.port = self.port, None
        if port is not None:
            port.close()
