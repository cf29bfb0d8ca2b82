"""A client of a runtime: one socket, whose answers are waited for."""

import os
import select
import socket
import time
from collections.abc import Callable
from types import TracebackType
from typing import Any, Final, Self, TypeVar

import msgspec

from windup.hal.errors import HardwareError, UsageError, WindupError
from windup.tools.command_line.version import installed_version
from windup.tools.remote.messages import (
    PROTOCOL,
    Ask,
    Change,
    Down,
    End,
    Ended,
    FromClient,
    Hello,
    Leased,
    Refused,
    Run,
    Started,
    Status,
    Take,
    ToClient,
    Welcome,
)
from windup.tools.remote.place import Place

PATIENCE: Final = 5.0
"""Longest time for the runtime to answer, s."""
CHUNK: Final = 1 << 16
DECODER: Final = msgspec.json.Decoder(ToClient)
ERRORS: Final[dict[int, type[WindupError]]] = {2: UsageError, 3: HardwareError}
T = TypeVar("T", Welcome, Leased, Started, Status)


class RuntimeClient:
    """A connection to the runtime of a robot.

    Args:
        robot: Name of the robot.
        name: What this client is, for people.
        place: Where the runtime is; by default that of this user.

    Attributes:
        welcome: What the runtime says about itself.
        on_status: Called with every status that comes while something else is waited for.

    Raises:
        UsageError: The robot is not up, or its runtime has another version.
    """

    def __init__(self, robot: str, name: str, place: Place | None = None) -> None:
        self._place = Place.of(robot) if place is None else place
        self.on_status: Callable[[Status], None] = lambda status: None
        self._numbers = 0
        self._over: dict[int, Ended] = {}
        self._in = bytearray()
        self._link = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            self._link.connect(str(self._place.socket))
        except OSError:
            self._link.close()
            raise self._place.not_up() from None
        self._poll = select.poll()  # select() takes no descriptor beyond 1023
        self._poll.register(self._link, select.POLLIN)
        try:
            hello = Hello(
                protocol=PROTOCOL, version=installed_version(), client=name, pid=os.getpid()
            )
            self.send(hello)
            self.welcome: Welcome = self._wait_for(Welcome)
        except BaseException:
            self.close()
            raise

    def status(self) -> Status:
        """Return how the runtime is."""
        self._numbers += 1
        self.send(Ask(id=self._numbers))
        while (status := self._wait_for(Status)).id != self._numbers:
            self.on_status(status)
        return status

    def take(self) -> None:
        """Take the lease.

        Raises:
            UsageError: Another client has it.
        """
        self.send(Take())
        self._wait_for(Leased)

    def run(self, behaviour: str, options: dict[str, Any], *, arm: bool = False) -> int:
        """Start a behaviour; return its number, for `wait`.

        Raises:
            UsageError: It cannot be, or another client has the robot; nothing has moved.
        """
        self._numbers += 1
        self.send(Run(id=self._numbers, behaviour=behaviour, options=options, arm=arm))
        while self._wait_for(Started, seconds=None).id != self._numbers:
            pass
        return self._numbers

    def wait(self, number: int) -> Ended:
        """Wait until behaviour `number` has ended; return how it went."""
        while (ended := self.ended(number, None)) is None:
            pass
        return ended

    def ended(self, number: int, seconds: float | None) -> Ended | None:
        """Return how behaviour `number` went, or None where nothing says so for `seconds` s.

        Raises:
            WindupError: A change that was asked for cannot be; the behaviour goes on.
            HardwareError: The runtime has ended.
        """
        if number not in self._over:
            self._sort(self.receive(seconds))
        return self._over.pop(number, None)

    def _sort(self, message: ToClient | None) -> None:
        """Keep, pass on or raise a message that nobody waits for at the moment.

        Raises:
            WindupError: A request was refused.
        """
        if isinstance(message, Refused):
            raise ERRORS.get(message.exit_status, WindupError)(message.message)
        if isinstance(message, Status):
            self.on_status(message)
        if isinstance(message, Ended):
            self._over[message.id] = message

    def change(
        self,
        *,
        speed: float | None = None,
        side: float | None = None,
        turn: float | None = None,
        style: dict[str, float] | None = None,
    ) -> None:
        """Change the walk that goes on: m/s, rad/s, amounts of styles; None leaves as it is."""
        self.send(Change(speed=speed, side=side, turn=turn, style=style or {}))

    def end(self) -> None:
        """End the behaviour; the robot comes to rest, if it can, and holds."""
        self.send(End())

    def down(self) -> None:
        """End the runtime; return when it has ended.

        Raises:
            HardwareError: It does not end.
        """
        self.send(Down())
        try:
            while self.receive(60.0) is not None:
                pass
        except HardwareError:
            return
        raise HardwareError(f"{self.welcome.robot} does not go down; try `windup stop`")

    def send(self, message: FromClient) -> None:
        """Send a message.

        Raises:
            HardwareError: The runtime has ended.
        """
        try:
            self._link.sendall(msgspec.json.encode(message) + b"\n")
        except OSError:
            raise self._ended() from None

    def receive(self, seconds: float | None) -> ToClient | None:
        """Return the next message, or None when none has come after `seconds` s.

        Raises:
            HardwareError: The runtime has ended.
        """
        until = None if seconds is None else time.monotonic() + seconds
        while b"\n" not in self._in:
            left = None if until is None else max(until - time.monotonic(), 0.0)
            if not self._poll.poll(None if left is None else 1e3 * left):
                return None
            try:
                data = self._link.recv(CHUNK)
            except OSError:
                data = b""
            if not data:
                raise self._ended()
            self._in += data
        line, _, rest = bytes(self._in).partition(b"\n")
        self._in = bytearray(rest)
        return DECODER.decode(line)

    def close(self) -> None:
        """Leave; what this client has begun ends, and the robot holds."""
        self._link.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _wait_for(self, kind: type[T], seconds: float | None = PATIENCE) -> T:
        """Return the next message of a kind; every status on the way is passed on.

        Raises:
            WindupError: The request was refused.
            HardwareError: The runtime has ended, or does not answer.
        """
        while (message := self.receive(seconds)) is not None:
            if isinstance(message, kind):
                return message
            self._sort(message)
        raise HardwareError(f"the runtime of {self._place.robot} does not answer")

    def _ended(self) -> HardwareError:
        return HardwareError(f"the runtime of {self._place.robot} has ended")
