"""A pyserial port that is connected to a world."""

import errno
import math
import os
import termios
from typing import cast

import serial

from windup.hal.backend import Clock
from windup.hal.errors import WindupError
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.world.address import parse_address
from windup.sim_twin.wire.world.bus_world import BusWorld
from windup.sim_twin.wire.world.clocks import RealClock
from windup.sim_twin.wire.world.worlds import OpenWorld, open_world, release_world

GONE = (errno.EIO, os.strerror(errno.EIO))  # what the kernel says of a terminal that hung up
PATIENCE = 60.0  # longest wait of a read without a time-out and answer, virtual s


class TwinSerial(serial.SerialBase):  # type: ignore[misc]
    """``twin://`` as a pyserial port.

    On a virtual clock, `write` only schedules; time advances in a blocking `read` and in
    `clock.wait_until`. A read without a time-out that can never end raises an error.

    A port whose adapter is unplugged raises what pyserial's raises on a Linux terminal that hung up
    (`serialposix.py`, tried on a pseudo-terminal): SerialException from read, write and settings,
    OSError from `in_waiting` and the modem lines, and `termios.error`, which is no OSError, from
    `flush` and from the resets of the buffers.
    """

    is_open: bool

    def open(self) -> None:
        """Open the world that the URL names, or join it if it is open already."""
        if self._port is None:
            raise serial.SerialException("a port needs a URL before it can be opened")
        if self.is_open:
            raise serial.SerialException("the port is open already")
        try:
            address = parse_address(self._port)
            self._running: OpenWorld = open_world(address)
        except WindupError as error:
            raise serial.SerialException(str(error)) from error
        self._bus: Bus = self._running.world.bus(address.bus)
        self._running.clock.settle()
        if not self._bus.plugged:
            release_world(self._running, address)
            raise serial.SerialException(f"the adapter of {self._port} is unplugged")
        self._address, self._plugs = address, self._bus.plugs
        self.is_open = True
        self._reconfigure_port()
        self.reset_input_buffer()

    def close(self) -> None:
        """Close the port and leave the world."""
        if self.is_open:
            self.is_open = False
            release_world(self._running, self._address if self._plugs != self._bus.plugs else None)

    @property
    def world(self) -> BusWorld:
        """The world behind the port."""
        return self._running.world

    @property
    def bus(self) -> Bus:
        """The bus that the port is plugged into."""
        return self._bus

    @property
    def clock(self) -> Clock:
        """The clock of the world."""
        return self._running.clock

    @property
    def latency(self) -> float:
        """Latency of the adapter, s; drivers add it to their deadlines."""
        return self._bus.timing.latency

    @property
    def in_waiting(self) -> int:
        """Number of bytes that can be read now."""
        self._check_ioctl()
        return self._bus.available()

    def read(self, size: int = 1) -> bytes:
        """Return `size` bytes, or those that have arrived by the time-out."""
        self._check()
        bus, clock = self._bus, self._running.clock
        limit = math.inf if self._timeout is None else clock.now() + self._timeout
        patience = clock.now() + PATIENCE
        schedule = self._running.world.schedule
        while (now := clock.now()) < limit and (arrival := bus.arrival(size)) > now:
            target = min(arrival, limit)
            if arrival == math.inf:
                target = min(limit, max(schedule.next, now))
            if target == math.inf or now > patience:
                if not isinstance(clock, RealClock) and limit == math.inf:
                    raise serial.SerialException(
                        "a read without a time-out on a bus without an answer would never return"
                    )
                target = min(target, now + 0.001)
            clock.wait_until(target)
            self._check_plug()
        clock.settle()
        return bus.read(size)

    def write(self, data: bytes | bytearray | memoryview) -> int:
        """Send bytes; the call returns at once, before they have left the wire."""
        self._check()
        sent = bytes(data)
        if sent:
            self._bus.write(sent)
        return len(sent)

    def flush(self) -> None:
        """Do nothing but check the port: written bytes are in transit already."""
        self._check_termios()

    def reset_input_buffer(self) -> None:
        """Discard the bytes that have arrived."""
        self._check_termios()
        self._bus.discard()

    def reset_output_buffer(self) -> None:
        """Do nothing but check the port: written bytes are in transit already."""
        self._check_termios()

    def _check(self) -> None:
        """Raise SerialException if the port is closed or unplugged, once the world is up to date.

        Settings, `read` and `write` do so.
        """
        self._is_gone()
        self._check_plug()

    def _check_ioctl(self) -> None:
        """Raise OSError if the port is unplugged: pyserial calls `ioctl`, and converts nothing."""
        if self._is_gone():
            raise OSError(*GONE)

    def _check_termios(self) -> None:
        """Raise `termios.error` if the port is unplugged: pyserial calls tcdrain or tcflush."""
        if self._is_gone():
            raise termios.error(*GONE)

    def _is_gone(self) -> bool:
        """Return whether the adapter was unplugged since the port was opened."""
        if not self.is_open:
            raise serial.PortNotOpenError()
        self._running.clock.settle()
        return self._plugs != self._bus.plugs

    def _check_plug(self) -> None:
        """Raise if the adapter was unplugged since the port was opened."""
        if self._plugs != self._bus.plugs:
            raise serial.SerialException("the adapter has been unplugged")

    def _reconfigure_port(self) -> None:
        self._check()
        self._bus.baud = cast(int, self._baudrate)

    # Control lines that a servo adapter has but does not use.

    def _update_break_state(self) -> None: ...

    def _update_rts_state(self) -> None: ...

    def _update_dtr_state(self) -> None: ...

    @property
    def cts(self) -> bool:
        """True while the adapter is plugged in."""
        self._check_ioctl()
        return True

    @property
    def dsr(self) -> bool:
        """True while the adapter is plugged in."""
        self._check_ioctl()
        return True

    @property
    def ri(self) -> bool:
        """Always False while the adapter is plugged in."""
        self._check_ioctl()
        return False

    @property
    def cd(self) -> bool:
        """True while the adapter is plugged in."""
        self._check_ioctl()
        return True
