"""The broker: a process that owns the socket of a runtime, so that its loop waits for no client.

It ends with the process of the loop. A client that does not read what it is sent is dropped.
"""

import json
import os
import selectors
import signal
import socket
import struct
import sys
from contextlib import suppress
from typing import Any, Final

import msgspec

from windup.hal.publishing.run_state import RunState
from windup.tools.remote.messages import LONGEST, Ended, Refused, ToClient, Welcome
from windup.tools.runtime.board import OVER, STATE, Board
from windup.tools.runtime.orders import REPORTS
from windup.tools.runtime.requests import Client, Requests

CHUNK: Final = 1 << 16
UNREAD: Final = 1 << 20
"""Bytes that may wait for a client that does not read; beyond it the client is dropped."""
NICENESS: Final = 5
CREDENTIALS: Final = struct.Struct("3i")


class Connection:
    """The socket of a client, with what has been received and what is still to be sent."""

    def __init__(self, link: socket.socket, number: int) -> None:
        self.link = link
        self.client = Client(number, self.send)
        self.open = True
        self._in, self._out = bytearray(), bytearray()
        link.setblocking(False)

    def send(self, message: ToClient) -> None:
        """Send a message now, or as soon as the client reads."""
        self._out += msgspec.json.encode(message) + b"\n"
        self.flush()

    def flush(self) -> None:
        """Send what can be sent without waiting."""
        try:
            while self._out:
                del self._out[: self.link.send(self._out)]
        except BlockingIOError:
            self.open = self.open and len(self._out) < UNREAD
        except OSError:
            self.open = False

    @property
    def unsent(self) -> bool:
        """True while something is still to be sent."""
        return bool(self._out)

    def lines(self) -> list[bytes]:
        """Return the complete lines that have come."""
        try:
            data = self.link.recv(CHUNK)
        except BlockingIOError:
            return []
        except OSError:
            data = b""
        if not data:
            self.open = False
            return []
        self._in += data
        *whole, rest = bytes(self._in).split(b"\n")
        self._in = bytearray(rest)
        self.open = len(rest) < LONGEST
        return [line for line in whole if line]


class Broker:
    """The broker of one runtime.

    Args:
        listener: The socket that listens for clients.
        board: The board.
        welcome: What every client is told first.
        bell: An eventfd that the loop writes to when its state has changed, or after a report.
        loop: A pidfd of the process of the loop.
    """

    def __init__(
        self, listener: socket.socket, board: Board, welcome: Welcome, bell: int, loop: int
    ) -> None:
        self._listener, self._board, self._bell, self._loop = listener, board, bell, loop
        self.requests = Requests(board, welcome)
        self._connections: dict[int, Connection] = {}
        self._count = 0
        self._state = int(RunState.DISCONNECTED)
        self._selector = selectors.DefaultSelector()
        for thing in (listener, bell, loop):
            self._selector.register(thing, selectors.EVENT_READ)
        listener.setblocking(False)

    def serve(self) -> None:
        """Serve clients until the loop has ended."""
        self._pass_on()  # what the loop has written before this process ran
        while True:
            for key, events in self._selector.select():
                if key.fileobj == self._loop:
                    self._pass_on()
                    return
                if key.fileobj == self._bell:
                    os.eventfd_read(self._bell)
                    self._pass_on()
                    if self._board.words[OVER]:
                        return
                elif key.fileobj is self._listener:
                    self._accept()
                else:
                    self._serve(key.data, events)

    def _accept(self) -> None:
        with suppress(OSError):
            link, _ = self._listener.accept()
            user = _user(link)
            self._count += 1
            connection = Connection(link, self._count)
            if user not in (0, os.getuid()):
                connection.send(Refused(message=f"this runtime belongs to user {os.getuid()}"))
                link.close()
                return
            self._connections[self._count] = connection
            self.requests.clients[self._count] = connection.client
            self._selector.register(link, selectors.EVENT_READ, connection)

    def _serve(self, connection: Connection, events: int) -> None:
        if events & selectors.EVENT_WRITE:
            connection.flush()
        if events & selectors.EVENT_READ and (lines := connection.lines()):
            self.requests.handle(connection.client, lines)
        self._settle(connection)

    def _pass_on(self) -> None:
        """Pass on what the loop reports, and its new state if that has changed."""
        while (text := self._board.reports.take()) is not None:
            report = REPORTS.decode(text)
            message = report.message
            if isinstance(message, Ended) or (isinstance(message, Refused) and message.id):
                self.requests.behaviour = ""
            if report.client == 0 and isinstance(message, Refused):
                self._say(message.message)
            if (connection := self._connections.get(report.client)) is not None:
                connection.send(report.message)
                self._settle(connection)
        if (state := self._board.words[STATE]) != self._state:
            self._state = state
            status = self.requests.status()
            doing = f" ({status.behaviour})" if status.behaviour else ""
            self._say(f"{status.state}{doing}")
            for connection in list(self._connections.values()):
                if connection.client.hello is not None:
                    connection.send(status)
                self._settle(connection)

    def _say(self, text: str) -> None:
        """Print a line in the terminal of the runtime, which the loop could not without waiting."""
        with suppress(OSError, ValueError, AttributeError):
            print(f"{self.requests.welcome.robot}: {text}", file=sys.stderr, flush=True)

    def _settle(self, connection: Connection) -> None:
        """Drop a client that has gone; wait for room where something is left to send."""
        if connection.open:
            wanted = selectors.EVENT_READ
            if connection.unsent:
                wanted |= selectors.EVENT_WRITE
            self._selector.modify(connection.link, wanted, connection)
            return
        if self._connections.pop(connection.client.number, None) is not None:
            self._selector.unregister(connection.link)
            self.requests.leave(connection.client)
            connection.link.close()


def _user(link: socket.socket) -> int:
    """Return the id of the user at the other end of a Unix socket."""
    found = link.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, CREDENTIALS.size)
    return int(CREDENTIALS.unpack(found)[1])


def main() -> None:
    """Run the broker with the descriptors and the welcome that stand in the first argument."""
    given: dict[str, Any] = json.loads(sys.argv[1])
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
        signal.signal(number, signal.SIG_IGN)  # it ends with the loop, which has to answer first
    with suppress(OSError):
        os.nice(NICENESS)
    loop = os.pidfd_open(os.getppid())
    if os.getppid() != given["pid"]:
        return
    listener = socket.socket(fileno=given["listener"])
    welcome = msgspec.convert(given["welcome"], Welcome)
    Broker(listener, Board.open(given["board"]), welcome, given["bell"], loop).serve()
