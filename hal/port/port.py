"""A serial port with its own clock: bytes, deadlines and nothing about servos."""

import contextlib
import os
import select
import termios
from collections.abc import Callable
from typing import Any, Protocol

from serial import SerialException

from windup.hal.backend import Clock
from windup.hal.clock import WallClock
from windup.hal.errors import PortError

GONE = (SerialException, OSError, termios.error)
"""What an adapter that is pulled out raises, depending on what was going on."""
SELECTABLE = 1024
"""Descriptors that `select` takes are less than this (FD_SETSIZE of the C library)."""
ROOM = 100
"""How long a write waits for room before it tries again, ms."""
LATENCY = 1e-3
"""What an adapter may hold back when its driver does not say, s."""
BITS = 10.0
"""A byte on the wire: start, eight, stop."""
PLENTY = 65_536
"""More bytes than a driver keeps."""


class SerialLike(Protocol):
    """The part of a pyserial object that a `Port` uses; timeouts are s on the object's clock."""

    baudrate: int
    timeout: float | None

    def read(self, size: int = 1, /) -> bytes:
        """Return up to `size` bytes, blocking no longer than `timeout`."""
        ...

    def write(self, data: bytes, /) -> int | None:
        """Send all of `data`."""
        ...

    def reset_input_buffer(self) -> None:
        """Forget what came in."""
        ...

    def close(self) -> None:
        """Give the device back."""
        ...


class Port:
    """One open port.

    A virtual world passes time only while somebody waits for it, so reads block until their
    deadline and never poll.

    Attributes:
        url: What was opened, as the user wrote it.
        place: The same, as it is found from every working folder.
        clock: The wall, or the clock of the world behind the port.
        latency: How long the adapter may hold back bytes that have arrived, s.
        echoes: Does the adapter give back all that is sent? Then reads leave that out.
        known: Have latency and echo been measured? See `windup.hal.port.adapter`.
        sent: Bytes written so far.
        received: Bytes read so far.
        has_baud: Does its baud rate reach the wire? A plain TCP bridge has one of its own.
    """

    has_baud = True

    def __init__(self, serial: SerialLike, url: str, latency: float | None = None) -> None:
        self._serial, self.url, self.place = serial, url, url
        world: Any = getattr(serial, "clock", None)
        self.clock: Clock = world if world is not None else WallClock()
        self.latency: float = getattr(serial, "latency", LATENCY) if latency is None else latency
        self.sent = self.received = 0
        self.echoes = self.known = False
        self._echo = 0  # bytes that were sent and have not been given back
        self._echo_end = 0.0  # when the last of them has been on the wire, s

    @property
    def baud(self) -> int:
        """Bits a second; assign to change it in place."""
        return self._serial.baudrate

    @baud.setter
    def baud(self, rate: int) -> None:
        if rate != self._serial.baudrate:
            try:
                self._serial.baudrate = rate
            except (*GONE, ValueError) as error:
                raise PortError(f"port {self.url} cannot run at {rate} baud: {error}") from None

    def read(self, count: int, deadline: float) -> bytes:
        """Return `count` bytes, or what has come when the clock says `deadline` s."""
        while self._echo:
            echo = self._take(self._echo, deadline)
            self._echo -= len(echo)
            if not echo:
                return b""
        data = self._take(count, deadline)
        self.received += len(data)
        return data

    def write(self, data: bytes) -> None:
        """Send `data`; returns when the driver has it, not when the wire has."""
        if self.echoes:
            start = max(self._echo_end, self.clock.now())
            self._echo_end = start + len(data) * BITS / self.baud
            self._echo += len(data)
        self._send(data)
        self.sent += len(data)

    def flush_input(self) -> None:
        """Forget bytes that have arrived: a late answer must not pass for the next one."""
        now = self.clock.now()
        if self._echo:
            self._echo -= min(self._echo, len(self._take(PLENTY, now)))
            if now > self._echo_end + self.latency + LATENCY:
                self._echo = 0  # what has not come back by now is lost
        self._discard()

    def settle(self, silence: float, longest: float) -> None:
        """Read and forget what comes until nothing has come for `silence` s.

        Gives up after `longest` s on a line that is never quiet.
        """
        end = self.clock.now() + longest
        while (now := self.clock.now()) < end and self._take(1, min(now + silence, end)):
            self._take(PLENTY, self.clock.now())
        self.flush_input()

    def _take(self, count: int, deadline: float) -> bytes:
        """Return what has come, as of `read`, with whatever the adapter has given back."""
        wait = deadline - self.clock.now()
        try:
            self._serial.timeout = wait if wait > 0.0 else 0.0
            return self._serial.read(count)
        except GONE as error:
            raise self._gone(error) from None

    def _send(self, data: bytes) -> None:
        try:
            self._serial.write(data)
        except GONE as error:
            raise self._gone(error) from None

    def _discard(self) -> None:
        try:
            self._serial.reset_input_buffer()
        except GONE as error:
            raise self._gone(error) from None

    def close(self) -> None:
        """Give the device back. Closing twice is no error."""
        with contextlib.suppress(*GONE):
            self._serial.close()

    def __enter__(self) -> "Port":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _gone(self, error: Exception) -> PortError:
        return PortError(
            f"port {self.url} went away ({error}); check cable and power, then open it again"
        )


def _selected(descriptor: int) -> Callable[[float], object]:
    """Return what waits some s for a descriptor to become readable, and says whether it has."""
    wait, watched = select.select, [descriptor]
    return lambda seconds: wait(watched, (), (), seconds)[0]


def _polled(descriptor: int) -> Callable[[float], object]:
    """The same for any descriptor; but it rounds the wait up to whole milliseconds."""
    poller = select.poll()
    poller.register(descriptor, select.POLLIN)
    return lambda seconds: poller.poll(seconds * 1e3)


class DevicePort(Port):
    """A port of the operating system: reads its descriptor itself, which costs half of pyserial."""

    def __init__(self, serial: Any, url: str, latency: float | None = None) -> None:
        super().__init__(serial, url, latency)
        self.place = url if url.startswith("usb:") else os.path.abspath(url)
        self._fd: int = serial.fileno()
        self._readable = (_selected if self._fd < SELECTABLE else _polled)(self._fd)

    def _take(self, count: int, deadline: float) -> bytes:
        chunks: list[bytes] = []
        left = count
        while left > 0:
            wait = deadline - self.clock.now()
            try:
                if not self._readable(wait if wait > 0.0 else 0.0):
                    break
                chunk = os.read(self._fd, left)
            except BlockingIOError:
                continue
            except OSError as error:
                raise self._gone(error) from None
            if not chunk:
                raise self._gone(OSError("end of file"))
            chunks.append(chunk)
            left -= len(chunk)
        return chunks[0] if len(chunks) == 1 else b"".join(chunks)

    def _send(self, data: bytes) -> None:
        view = memoryview(data)
        while view:
            try:
                view = view[os.write(self._fd, view) :]
            except BlockingIOError:
                writable = select.poll()
                writable.register(self._fd, select.POLLOUT)
                writable.poll(ROOM)
            except OSError as error:
                raise self._gone(error) from None
