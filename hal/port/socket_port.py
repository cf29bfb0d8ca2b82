"""A serial port over TCP that transmits bytes but no baud rate, such as ser2net's raw mode.

pyserial's own `socket://` waits with `select`, which fails for descriptors above 1023; it leaves
Nagle's algorithm on, which delays a request by 40 ms, and sleeps for 0.3 s when it closes.
"""

import contextlib
import socket
from urllib.parse import urlsplit

from windup.hal.errors import UsageError
from windup.hal.port.port import DevicePort

RAW = "socket://"
"""URL prefix of such ports."""
CONNECT_TIME = 5.0
"""Maximum time to connect, s."""
CHUNK = 4096


class Connection:
    """A TCP connection with the part of the pyserial interface that `SocketPort` uses.

    Args:
        url: ``socket://HOST:PORT``.
        baud: Baud rate that the remote port is assumed to be set to, bit/s.

    Raises:
        OSError: The connection cannot be made.
        UsageError: The URL has no host or no port.
    """

    def __init__(self, url: str, baud: int) -> None:
        parts = urlsplit(url)
        if not parts.hostname or parts.port is None:
            raise UsageError(f"{url}: a host and a port are missing: {RAW}HOST:PORT")
        self.baudrate = baud
        self._socket = socket.create_connection((parts.hostname, parts.port), CONNECT_TIME)
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def fileno(self) -> int:
        """Return the descriptor of the socket."""
        return self._socket.fileno()

    def reset_input_buffer(self) -> None:
        """Discard received bytes."""
        with contextlib.suppress(BlockingIOError):
            while self._socket.recv(CHUNK):
                pass

    def close(self) -> None:
        """Close the connection."""
        self._socket.close()


class SocketPort(DevicePort):
    """A port over a raw TCP connection."""

    has_baud = False

    def __init__(self, connection: Connection, url: str) -> None:
        super().__init__(connection, url)
        self.absolute_url = url
