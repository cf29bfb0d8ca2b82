"""Starts the broker of a runtime, from the process of the loop."""

import json
import os
import socket
import subprocess
import sys
from contextlib import suppress
from typing import Final

import msgspec

from windup.hal.error_text import error_text
from windup.hal.errors import UsageError
from windup.hal.guardian.child_path import child_python_path
from windup.tools.remote.messages import Welcome
from windup.tools.remote.place import Place
from windup.tools.runtime.board import OVER, Board

BODY: Final = "from windup.tools.runtime.broker import main; main()"
BACKLOG: Final = 16
GOODBYE: Final = 1.0
"""Time for the broker to pass on the last reports at the end, s."""


class BrokerProcess:
    """The broker as its parent, the loop, knows it.

    Args:
        place: Where the socket is to be.
        board: The board, which the broker inherits.
        welcome: What every client is told first.

    Raises:
        UsageError: The socket cannot be made, or the process does not start.
    """

    def __init__(self, place: Place, board: Board, welcome: Welcome) -> None:
        self._board = board
        listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._bell = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
        try:
            before = os.umask(0o177)
            try:
                listener.bind(str(place.socket))
            finally:
                os.umask(before)
            listener.listen(BACKLOG)
            given = {
                "pid": os.getpid(),
                "listener": listener.fileno(),
                "board": board.descriptor,
                "bell": self._bell,
                "welcome": msgspec.to_builtins(welcome),
            }
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-c", BODY, json.dumps(given)],
                stdin=subprocess.DEVNULL,
                pass_fds=(listener.fileno(), board.descriptor, self._bell),
                env={**os.environ, "PYTHONPATH": child_python_path()},
                start_new_session=True,  # signals of the terminal go to the loop only
            )
        except OSError as error:
            os.close(self._bell)
            why = error_text(error)
            raise UsageError(f"the broker of {place.robot} does not start: {why}") from None
        finally:
            listener.close()

    @property
    def alive(self) -> bool:
        """True while the process runs."""
        return self._process.poll() is None

    def ring(self) -> None:
        """Tell the broker that the state has changed, or that there is a report; never waits."""
        if self._bell >= 0:
            with suppress(BlockingIOError):
                os.eventfd_write(self._bell, 1)

    def end(self) -> None:
        """End the process; it passes on the last reports before."""
        self._board.words[OVER] = 1
        self.ring()
        try:
            self._process.wait(GOODBYE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._bell)
        self._bell = -1
