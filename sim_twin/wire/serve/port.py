"""A pyserial port that is connected to a world."""

import math
from typing import cast

import serial

from windup.hal.backend import Clock
from windup.hal.errors import WindupError
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.world.address import parse_address
from windup.sim_twin.wire.world.bus_world import BusWorld
from windup.sim_twin.wire.world.clocks import RealClock
from windup.sim_twin.wire.world.worlds import OpenWorld, open_world, release_world

PATIENCE = 60.0  # longest wait of a read without a time-out and answer, virtual s


class TwinSerial(serial.SerialBase):  # type: ignore[misc]
    """``twin://`` as a pyserial port.

    On a virtual clock, `write` only schedules; time advances in a blocking `read` and in
    `clock.wait_until`. A read without a time-out that can never end raises an error.
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
        self._check()
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
        """Do nothing: written bytes are in transit already."""

    def reset_input_buffer(self) -> None:
        """Discard the bytes that have arrived."""
        self._check()
        self._bus.discard()

    def reset_output_buffer(self) -> None:
        """Do nothing: written bytes are in transit already."""

    def _check(self) -> None:
        """Raise if the port is closed or unplugged; let a real clock catch up."""
        if not self.is_open:
            raise serial.PortNotOpenError()
        self._check_plug()
        self._running.clock.settle()

    def _check_plug(self) -> None:
        """Raise if the adapter was unplugged since the port was opened."""
        if self._plugs != self._bus.plugs:
            raise serial.SerialException("the adapter has been unplugged")

    def _reconfigure_port(self) -> None:
        self._bus.baud = cast(int, self._baudrate)

    # Control lines that a servo adapter has but does not use.

    def _update_break_state(self) -> None: ...

    def _update_rts_state(self) -> None: ...

    def _update_dtr_state(self) -> None: ...

    @property
    def cts(self) -> bool:
        """Always True."""
        return True

    @property
    def dsr(self) -> bool:
        """Always True."""
        return True

    @property
    def ri(self) -> bool:
        """Always False."""
        return False

    @property
    def cd(self) -> bool:
        """Always True."""
        return True
