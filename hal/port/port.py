"""A serial port with its own clock: reads and writes bytes with deadlines."""

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
"""Exceptions raised by a port whose adapter is unplugged, depending on the operation."""
SELECTABLE = 1024
"""Descriptors have to be less than this for `select` (FD_SETSIZE of the C library)."""
ROOM = 100
"""Maximum time that a write waits for buffer space before it retries, ms."""
LATENCY = 1e-3
"""Assumed latency of an adapter whose driver does not report one, s."""
BITS = 10.0
"""Bits per byte on the wire: start, eight data bits, stop."""
PLENTY = 65_536
"""Read size that exceeds the input buffer of any driver, bytes."""


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
        """Discard received bytes."""
        ...

    def close(self) -> None:
        """Close the device."""
        ...


class Port:
    """One open port.

    A virtual clock advances only while a call waits for it, so reads block until their deadline
    and never poll.

    Attributes:
        url: URL as the user wrote it.
        absolute_url: The same URL, independent of the working folder.
        clock: Wall clock, or virtual clock of a simulated port.
        latency: Maximum time for which the adapter delays received bytes, s.
        echoes: Whether the adapter echoes all bytes sent; reads then remove the echo.
        is_measured: Whether latency and echo have been measured; see `windup.hal.port.adapter`.
        sent: Number of bytes written so far.
        received: Number of bytes read so far, without the echo.
        has_baud: Whether its baud rate applies to the wire; a raw TCP bridge sets its own.
    """

    has_baud = True

    def __init__(self, serial: SerialLike, url: str, latency: float | None = None) -> None:
        self._serial, self.url, self.absolute_url = serial, url, url
        world: Any = getattr(serial, "clock", None)
        self.clock: Clock = world if world is not None else WallClock()
        self.latency: float = getattr(serial, "latency", LATENCY) if latency is None else latency
        self.sent = self.received = 0
        self.echoes = self.is_measured = False
        self._echo = 0  # number of bytes sent whose echo has not been read
        self._echo_end = 0.0  # when the last of them has left the wire, s

    @property
    def baud(self) -> int:
        """Baud rate, bit/s; assign to change it on the open port."""
        return self._serial.baudrate

    @baud.setter
    def baud(self, rate: int) -> None:
        if rate != self._serial.baudrate:
            try:
                self._serial.baudrate = rate
            except (*GONE, ValueError) as error:
                raise PortError(f"port {self.url} does not support {rate} baud: {error}") from None

    def read(self, count: int, deadline: float) -> bytes:
        """Return `count` bytes, or those received when the clock reaches `deadline` s."""
        while self._echo:
            echo = self._take(self._echo, deadline)
            self._echo -= len(echo)
            if not echo:
                return b""
        data = self._take(count, deadline)
        self.received += len(data)
        return data

    def write(self, data: bytes) -> None:
        """Send `data`; returns when the driver has taken it, before it is on the wire."""
        if self.echoes:
            start = max(self._echo_end, self.clock.now())
            self._echo_end = start + len(data) * BITS / self.baud
            self._echo += len(data)
        self._send(data)
        self.sent += len(data)

    def flush_input(self) -> None:
        """Discard received bytes, so that a late answer is not taken for the next one."""
        now = self.clock.now()
        if self._echo:
            self._echo -= min(self._echo, len(self._take(PLENTY, now)))
            if now > self._echo_end + self.latency + LATENCY:
                self._echo = 0  # an echo that has not come by now is lost
        self._discard()

    def drain_input(self, silence: float, longest: float) -> None:
        """Read and discard bytes until none has come for `silence` s.

        Gives up after `longest` s if the line is never quiet.
        """
        end = self.clock.now() + longest
        while (now := self.clock.now()) < end and self._take(1, min(now + silence, end)):
            self._take(PLENTY, self.clock.now())
        self.flush_input()

    def _take(self, count: int, deadline: float) -> bytes:
        """Return bytes as `read` does, but including the echo."""
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
        """Close the device. Closing twice is not an error."""
        with contextlib.suppress(*GONE):
            self._serial.close()

    def __enter__(self) -> "Port":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _gone(self, error: Exception) -> PortError:
        why = error.args[-1] if isinstance(error, termios.error) else error  # not "(5, '...')"
        return PortError(
            f"port {self.url} was disconnected ({why}); check cable and power, then open it again"
        )


def _selected(descriptor: int) -> Callable[[float], object]:
    """Return a function that waits up to some s until a descriptor is readable; truthy if so."""
    wait, watched = select.select, [descriptor]
    return lambda seconds: wait(watched, (), (), seconds)[0]


def _polled(descriptor: int) -> Callable[[float], object]:
    """Like `_selected`, for any descriptor; but it rounds the wait up to whole milliseconds."""
    poller = select.poll()
    poller.register(descriptor, select.POLLIN)
    return lambda seconds: poller.poll(seconds * 1e3)


class DevicePort(Port):
    """A device file: reads its descriptor directly, which takes half the time of pyserial."""

    def __init__(self, serial: Any, url: str, latency: float | None = None) -> None:
        super().__init__(serial, url, latency)
        self.absolute_url = url if url.startswith("usb:") else os.path.abspath(url)
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
