"""A serial port over TCP that also transmits the baud rate: RFC 2217, as served by ser2net."""

import contextlib
import socket
from typing import Any

from windup.hal.port.port import Port
from windup.hal.port.socket_port import RAW

RFC2217 = "rfc2217://"
"""URL prefix of such ports."""
NETWORK = (RAW, RFC2217)
"""URL prefixes of all ports over TCP."""


class NetworkPort(Port):
    """A port of pyserial's `rfc2217://`, adapted for a control loop.

    pyserial leaves Nagle's algorithm on: a request after an unanswered goal write would wait for
    the delayed acknowledgement of the peer, 40 ms. And it sleeps for 0.3 s when it closes.
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
        self._serial.is_open = False  # else pyserial's destructor closes it again, and sleeps
        with contextlib.suppress(OSError):
            self._connection.close()
