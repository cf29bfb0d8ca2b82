"""A serial port behind a TCP connection that passes bytes and no baud rate, as ser2net's raw mode.

pyserial's own `socket://` waits with `select`, which takes no descriptor beyond 1023; it leaves
Nagle's algorithm on, behind which a request waits for 40 ms, and sleeps for 0.3 s when it closes.
"""

import contextlib
import socket
from urllib.parse import urlsplit

from windup.hal.errors import UsageError
from windup.hal.port.port import DevicePort

RAW = "socket://"
"""How the URLs of such ports begin."""
CONNECT_TIME = 5.0
"""How long a connection may take, s."""
CHUNK = 4096


class Connection:
    """A connection with what `Port` asks of a pyserial object.

    Args:
        url: ``socket://HOST:PORT``.
        baud: What its other side is taken to be set to.

    Raises:
        OSError: Nobody answers there.
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
        """Return its descriptor."""
        return self._socket.fileno()

    def reset_input_buffer(self) -> None:
        """Forget what came in."""
        with contextlib.suppress(BlockingIOError):
            while self._socket.recv(CHUNK):
                pass

    def close(self) -> None:
        """End it."""
        self._socket.close()


class SocketPort(DevicePort):
    """Such a port."""

    has_baud = False

    def __init__(self, connection: Connection, url: str) -> None:
        super().__init__(connection, url)
        self.place = url
