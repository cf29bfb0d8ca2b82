"""A serial port behind a TCP connection that passes baud rates too: RFC 2217, as of ser2net."""

import contextlib
import socket
from typing import Any

from windup.hal.port.port import Port
from windup.hal.port.socket_port import RAW

RFC2217 = "rfc2217://"
"""How the URLs of such ports begin."""
NETWORK = (RAW, RFC2217)
"""The same, of all ports behind a TCP connection."""


class NetworkPort(Port):
    """A port of pyserial's `rfc2217://`, made fit for a control loop.

    pyserial leaves Nagle's algorithm on: a request behind a goal that nobody answers would wait for
    the other side's delayed acknowledgement, 40 ms. And it sleeps for 0.3 s when it closes.
    """

    def __init__(self, serial: Any, url: str, latency: float | None = None) -> None:
        super().__init__(serial, url, latency)
        self._serial: Any = serial
        connection = getattr(serial, "_socket", None)
        self._connection = connection if isinstance(connection, socket.socket) else None
        if self._connection is not None:
            self._connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def close(self) -> None:
        """Close the connection at once. Closing twice is no error."""
        if self._connection is None:
            super().close()
            return
        self._serial.is_open = False  # or pyserial closes it again, and sleeps, when it is freed
        with contextlib.suppress(OSError):
            self._connection.close()
