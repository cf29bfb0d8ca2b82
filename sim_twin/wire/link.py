"""Where other programs plug into an emulated bus: a pseudo-terminal, or a TCP port."""

import contextlib
import fcntl
import os
import socket
import struct
import termios
import tty
from pathlib import Path
from typing import Protocol

from hal.errors import UsageError

TCGETS2 = 0x802C542A
TERMIOS2 = struct.Struct("4I20B2I")  # the last two: input and output speed, baud
CHUNK = 4096


class Link(Protocol):
    """One plug."""

    @property
    def name(self) -> str:
        """What a program has to open."""
        ...

    def descriptors(self) -> list[int]:
        """Return what to wait for."""
        ...

    def receive(self) -> bytes:
        """Return what the program has sent; nothing is fine."""
        ...

    def send(self, data: bytes) -> None:
        """Give bytes to the program, or lose them if it is not there."""
        ...

    def baud(self) -> int | None:
        """Return the program's baud rate; None where it cannot be seen."""
        ...

    def close(self) -> None:
        """Unplug."""
        ...


class Pty:
    """A pseudo-terminal, under a path of your choice.

    Raises:
        UsageError: Something that is not a link is at that path already.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        target = os.ttyname(self._slave)
        if path.is_symlink():
            path.unlink()
        elif path.exists():
            raise UsageError(f"{path} exists and is not a link; choose another path")
        path.symlink_to(target)

    @property
    def name(self) -> str:
        """Its path."""
        return str(self._path)

    def descriptors(self) -> list[int]:
        """Return what to wait for."""
        return [self._master]

    def receive(self) -> bytes:
        """Return what the program has sent."""
        try:
            return os.read(self._master, CHUNK)
        except OSError:
            return b""

    def send(self, data: bytes) -> None:
        """Give bytes to the program; what it never reads is lost in the end."""
        with contextlib.suppress(OSError):
            os.write(self._master, data)

    def baud(self) -> int | None:
        """Return the baud rate that the program has set, standard or not."""
        raw = fcntl.ioctl(self._master, TCGETS2, bytes(TERMIOS2.size))
        speed = TERMIOS2.unpack(raw)[-1]
        return int(speed) or None

    def close(self) -> None:
        """Remove the path and the terminal."""
        with contextlib.suppress(OSError):
            self._path.unlink()
        termios.tcflush(self._slave, termios.TCIOFLUSH)
        os.close(self._master)
        os.close(self._slave)


def free_port(host: str = "127.0.0.1") -> int:
    """Return a TCP port that nobody uses now."""
    with socket.create_server((host, 0)) as server:
        return int(server.getsockname()[1])


class Tcp:
    """A TCP port on this machine; the bus keeps its baud rate.

    It is for one program at a time: the connection of a second one is closed at once while that of
    the first lives. A program that was killed, or has closed its connection, makes room.
    """

    def __init__(self, port: int, host: str = "127.0.0.1") -> None:
        self._server = socket.create_server((host, port))
        self._server.setblocking(False)
        self._client: socket.socket | None = None

    @property
    def name(self) -> str:
        """Its URL."""
        host, port = self._server.getsockname()[:2]
        return f"socket://{host}:{port}"

    def descriptors(self) -> list[int]:
        """Return what to wait for."""
        client = [] if self._client is None else [self._client.fileno()]
        return [self._server.fileno(), *client]

    def receive(self) -> bytes:
        """Return what the program has sent; take a new program in, or refuse it."""
        data = self._read()
        with contextlib.suppress(BlockingIOError):
            client, _ = self._server.accept()
            if self._client is not None:
                client.close()
                return data
            client.setblocking(False)
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._client = client
        return data

    def _read(self) -> bytes:
        """Return all that the program has sent; drop it if it is gone."""
        data = b""
        while self._client is not None:
            try:
                chunk = self._client.recv(CHUNK)
            except BlockingIOError:
                break
            except OSError:
                chunk = b""
            data += chunk
            if not chunk:
                self._drop()
        return data

    def send(self, data: bytes) -> None:
        """Give bytes to the program, or lose them."""
        if self._client is not None:
            with contextlib.suppress(OSError):
                self._client.send(data)

    def baud(self) -> int | None:
        """Nobody says."""
        return None

    def close(self) -> None:
        """Close port and program."""
        self._drop()
        self._server.close()

    def _drop(self) -> None:
        if self._client is not None:
            self._client.close()
            self._client = None
