"""Connections from other programs to an emulated bus: a pseudo-terminal, or a TCP port."""

import contextlib
import fcntl
import os
import re
import socket
import struct
import termios
import tty
from pathlib import Path
from typing import Protocol

from windup.hal.errors import UsageError

TCGETS2 = 0x802C542A
TERMIOS2 = struct.Struct("4I20B2I")  # the last two fields: input and output speed, baud
CHUNK = 4096
OURS = re.compile(r"/dev/pts/\d+")  # targets of the symbolic links that emulators make
VISITORS = 64  # largest number of connections that one call accepts or refuses


class Link(Protocol):
    """A connection from one program to a bus."""

    @property
    def name(self) -> str:
        """Path or URL that a program has to open."""
        ...

    def descriptors(self) -> list[int]:
        """Return the descriptors to wait for."""
        ...

    def receive(self, most: int) -> bytes:
        """Return what the program has sent, up to about `most` bytes; possibly nothing."""
        ...

    def send(self, data: bytes) -> None:
        """Send bytes to the program, or discard them if it is not connected."""
        ...

    def baud(self) -> int | None:
        """Return the program's baud rate; None if it cannot be determined."""
        ...

    def close(self) -> None:
        """Close the connection."""
        ...


class Pty:
    """A pseudo-terminal, under a path of the caller's choice.

    It can lose bytes that a program writes and immediately flushes with `tcflush`, as pyserial's
    `reset_output_buffer` does: a kernel worker carries the bytes across (`tty_buffer.c`), and a
    flush discards those that it has not carried yet, however fast the other end reads. Measured on
    two processors: 18 to 50 % of the writes with the flush right behind, 0.7 % with 0.3 ms between;
    18 % of pypot's sync writes in threes, none of those 1 ms apart.

    Raises:
        UsageError: Something other than the link of a dead emulator is at that path already, or
            nothing can be created there.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        _make_room(path)
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self._target = os.ttyname(self._slave)
        try:
            path.symlink_to(self._target)
        except OSError as error:
            self._hang_up()
            raise UsageError(f"cannot make {path}: {error.strerror}") from None

    @property
    def name(self) -> str:
        """The path to open."""
        return str(self._path)

    def descriptors(self) -> list[int]:
        """Return the descriptors to wait for."""
        return [self._master]

    def receive(self, most: int) -> bytes:
        """Return all that the program has sent.

        Reading only the first piece is not enough: while the kernel's buffer is full, it discards
        what a program has written and then flushes.
        """
        data = bytearray()
        with contextlib.suppress(OSError):
            while len(data) < most and (chunk := os.read(self._master, CHUNK)):
                data += chunk
        return bytes(data)

    def send(self, data: bytes) -> None:
        """Send bytes to the program; bytes that it never reads are lost eventually."""
        with contextlib.suppress(OSError):
            os.write(self._master, data)

    def baud(self) -> int | None:
        """Return the baud rate that the program has set, standard or not."""
        raw = fcntl.ioctl(self._master, TCGETS2, bytes(TERMIOS2.size))
        speed = TERMIOS2.unpack(raw)[-1]
        return int(speed) or None

    def close(self) -> None:
        """Close the terminal, and remove the path if it still leads there."""
        with contextlib.suppress(OSError):
            if os.readlink(self._path) == self._target:
                self._path.unlink()
        self._hang_up()

    def _hang_up(self) -> None:
        termios.tcflush(self._slave, termios.TCIOFLUSH)
        os.close(self._master)
        os.close(self._slave)


def _make_room(path: Path) -> None:
    """Remove the link of a dead emulator at `path`; never remove anything else.

    Raises:
        UsageError: Something else is at that path.
    """
    other = "choose another path"
    if not path.is_symlink():
        if path.exists():
            raise UsageError(f"{path} exists and is not the link of an emulated port; {other}")
        return
    target = os.readlink(path)
    if OURS.fullmatch(target) is None:
        raise UsageError(f"{path} is a link to {target}, not to an emulated port; {other}")
    if os.path.exists(target):
        used = f"{path} is a link to {target}, which is in use, perhaps by an emulator"
        raise UsageError(f"{used}; end that, or {other}")
    path.unlink()


def free_port(host: str = "127.0.0.1") -> int:
    """Return a TCP port that is free now."""
    with socket.create_server((host, 0)) as server:
        return int(server.getsockname()[1])


class Tcp:
    """A TCP port on this machine; the bus keeps its own baud rate.

    It serves one program at a time: while the first connection is open, a second one is closed at
    once. After a program has closed its connection, or was killed, the next one can connect.
    """

    def __init__(self, port: int, host: str = "127.0.0.1") -> None:
        self._server = socket.create_server((host, port))
        self._server.setblocking(False)
        self._client: socket.socket | None = None

    @property
    def name(self) -> str:
        """The URL to open."""
        host, port = self._server.getsockname()[:2]
        return f"socket://{host}:{port}"

    def descriptors(self) -> list[int]:
        """Return the descriptors to wait for."""
        client = [] if self._client is None else [self._client.fileno()]
        return [self._server.fileno(), *client]

    def receive(self, most: int) -> bytes:
        """Return what the program has sent; also accept or refuse new connections."""
        data = self._read(most)
        with contextlib.suppress(OSError):  # no pending connection, or one that is closed already
            for _ in range(VISITORS):
                client, _ = self._server.accept()
                self._welcome(client)
        return data

    def _welcome(self, client: socket.socket) -> None:
        """Accept a connection, or close it if there is one already."""
        if self._client is not None:
            client.close()
            return
        client.setblocking(False)
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._client = client

    def _read(self, most: int) -> bytes:
        """Return what the program has sent; close its connection if it has closed it."""
        data = bytearray()
        while self._client is not None and len(data) < most:
            try:
                chunk = self._client.recv(CHUNK)
            except BlockingIOError:
                break
            except OSError:
                chunk = b""
            data += chunk
            if not chunk:
                self._drop()
        return bytes(data)

    def send(self, data: bytes) -> None:
        """Send bytes to the program, or discard them if none is connected."""
        if self._client is not None:
            with contextlib.suppress(OSError):
                self._client.send(data)

    def baud(self) -> int | None:
        """Return None: TCP carries no baud rate."""
        return None

    def close(self) -> None:
        """Close the port and the connection."""
        self._drop()
        self._server.close()

    def _drop(self) -> None:
        if self._client is not None:
            self._client.close()
            self._client = None
