"""A half-duplex bus that carries bytes in time, at a baud rate, from one sender at a time.

Bytes that two senders send at the same time arrive as noise. A device receives the host only at its
own baud rate, and the host receives a device only at the host's.
"""

import math
import random
from collections.abc import Callable, Sequence
from functools import partial
from typing import Protocol

from windup.sim_twin.wire.bus.inbox import Burst, Inbox
from windup.sim_twin.wire.bus.parsed_item import ParsedItem
from windup.sim_twin.wire.bus.timing import Timing
from windup.sim_twin.wire.bus.traffic import Traffic
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.imu.bno055 import Bno055Registers
from windup.sim_twin.wire.imu.imu_faults import FaultyImu
from windup.sim_twin.wire.schedule import Schedule

BITS = 10  # per byte: one start, eight data, one stop
FORGET = 0.1  # pause after which an incomplete frame is discarded, s
BAUD_TOLERANCE = 0.03
PIECE = 4096  # largest number of host bytes that are parsed at once


class WireProtocol(Protocol):
    """A protocol: how bytes become frames, and what devices do with a frame.

    Attributes:
        id_at: Index of the id in a frame.
        length_at: Index of the length (its low byte) in a frame.
        data_at: Index of the data in a status packet.
        tail: Number of bytes of the checksum.
    """

    id_at: int
    length_at: int
    data_at: int
    tail: int

    def with_checksum(self, frame: bytes, /) -> bytes:
        """Return `frame` with the correct checksum."""
        ...

    def set_devices(self, devices: Sequence[Device], /) -> None:
        """Register the devices; called whenever registers below 64 may have changed."""
        ...

    def feed(self, chunk: bytes) -> list[ParsedItem]:
        """Return the frames that `chunk` completes."""
        ...

    def reset(self) -> None:
        """Discard an incomplete frame."""
        ...

    def execute(self, frame: ParsedItem, bus: "Bus") -> bool:
        """Execute a frame; return False if it was dropped."""
        ...


class FaultInjector(Protocol):
    """The faults of a bus, applied to what is sent on it.

    Attributes:
        active: Whether any fault is configured.
    """

    active: bool

    def answer(self, bus: "Bus", data: bytes, baud: int, identifier: int) -> float:
        """Send a status packet with the faults that hit it now; return when it ends, s."""
        ...

    def echoes(self, bus: "Bus") -> bool:
        """Return whether the adapter echoes the host's present bytes back to it."""
        ...

    def noise(self, count: int) -> bytes:
        """Return random bytes, as received in a collision or at a wrong baud rate."""
        ...


class Bus:
    """One bus, with its devices and its host adapter.

    Attributes:
        name: Name of the bus.
        devices: The devices on it. Call `refresh` after changing ids from outside.
        protocol: The protocol of its devices.
        baud: Baud rate of the host.
        schedule: The schedule of the world.
        timing: Latencies.
        faults: The faults; set by the world.
        last_instruction: Time at which the last valid instruction ended, s.
        began: Time at which the host's last bytes began, s.
        counts: Numbers of "frames" executed, frames "dropped", and "collisions".
        plugged: Whether the host's adapter is plugged in.
        plugs: Number of times that the adapter was pulled out or plugged in.
        spoken: Protocol version of the frame being executed; devices with another version do not
            receive it. None: all devices have the same version.
        imu: IMU that a board on the bus reports, or that sends on the bus by itself.
        chip: The IMU's registers where this is an I2C bus, which carries no servo bytes.
        tap: Called with the direction (">" from the host), the baud rate and each burst.
    """

    def __init__(
        self,
        name: str,
        devices: list[Device],
        protocol: WireProtocol,
        schedule: Schedule,
        baud: int = 1_000_000,
        timing: Timing | None = None,
    ) -> None:
        self.name, self.devices, self.protocol, self.schedule = name, devices, protocol, schedule
        self.timing = timing or Timing()
        self.faults: FaultInjector | None = None
        self.last_instruction = self.began = 0.0
        self.counts = {"frames": 0, "dropped": 0, "collisions": 0}
        self.plugged, self.plugs = True, 0
        self.spoken: int | None = None
        self.imu: FaultyImu | None = None
        self.chip: Bno055Registers | None = None
        self.tap: Callable[[str, int, Burst], None] | None = None
        self._dice = random.Random(0)
        self._baud = baud
        self._sent = -math.inf  # end of the host's last byte, s
        self._out = -math.inf  # time until which the adapter stays pulled out, s
        self._traffic = Traffic()
        self.inbox = Inbox(self.timing.latency)
        self._by_id: dict[int, list[Device]] = {}
        self.refresh()

    @property
    def fault_injector(self) -> FaultInjector | None:
        """The faults, or None while none is active."""
        return self.faults if self.faults is not None and self.faults.active else None

    @property
    def baud(self) -> int:
        """Baud rate of the host."""
        return self._baud

    @baud.setter
    def baud(self, baud: int) -> None:
        if baud != self._baud:
            self._baud = baud
            self.protocol.reset()

    def refresh(self) -> None:
        """Update the tables of ids and protocols from the devices."""
        self.protocol.set_devices(self.devices)
        self._by_id.clear()
        for device in self.devices:
            self._by_id.setdefault(device.identifier, []).append(device)
            if device.secondary_id < 253 and device.secondary_id != device.identifier:
                self._by_id.setdefault(device.secondary_id, []).append(device)

    # The host's side

    def write(self, data: bytes) -> None:
        """Send bytes from the host, now or after those that are still in transit."""
        start = max(self.schedule.now, self._sent)
        if start - self._sent > FORGET:
            self.protocol.reset()
        burst = Burst(start, BITS / self._baud, bytearray(data))
        self._sent, self.began = burst.end, start
        self.counts["collisions"] += self._traffic.add(burst, self.schedule.now, self._noise)
        if self.tap is not None:
            self.tap(">", self._baud, burst)
        wrong = self.fault_injector
        if wrong is not None and wrong.echoes(self) and self.plugged:
            self.inbox.append(Burst(burst.start, burst.byte_time, bytearray(burst.data)))
        for at in range(0, len(burst.data), PIECE):
            for item in self.protocol.feed(bytes(burst.data[at : at + PIECE])):
                if item.noise:
                    self.protocol.execute(item, self)
                    self.counts["dropped"] += 1
                    continue
                end = start + (at + item.end) * burst.byte_time
                self.schedule.add(end, partial(self._execute_frame, item, burst, end))

    @property
    def backlog(self) -> float:
        """Time for which the host's bytes still occupy the wire, s."""
        return max(self._sent - self.schedule.now, 0.0)

    def available(self) -> int:
        """Return the number of bytes that the host has received and not read."""
        return self.inbox.available(self.schedule.now)

    def arrival(self, count: int) -> float:
        """Return when the host has `count` bytes, s; infinity if fewer are in transit."""
        return self.inbox.arrival(count)

    def read(self, count: int) -> bytes:
        """Return up to `count` bytes that have arrived."""
        return self.inbox.read(count, self.schedule.now)

    @property
    def queued(self) -> int:
        """Number of bytes that the host has not read, received or in transit."""
        return self.inbox.queued

    def discard(self) -> None:
        """Discard the bytes that the host has received and not read."""
        self.read(self.available())

    def set_plugged(self, there: bool) -> None:
        """Pull the host's adapter out or plug it in; ports opened before stay dead in any case."""
        if there != self.plugged:
            self.plugged = there
            self.plugs += 1
            self.inbox.clear()
            self.protocol.reset()

    def unplug(self, seconds: float) -> None:
        """Pull the adapter out, and plug it in after some seconds (infinity: never)."""
        self.set_plugged(False)
        back = self.schedule.now + seconds
        self._out = max(self._out, back)
        if back < math.inf:
            self.schedule.add(back, self._plug_in)

    def _plug_in(self) -> None:
        if self.schedule.now >= self._out:  # no later call of `unplug` lasts longer
            self.set_plugged(True)

    # The devices' side

    def listeners(self, identifier: int) -> list[Device]:
        """Return the devices that hear the host and have this id or secondary id."""
        found = self._by_id.get(identifier)
        return [device for device in found if self.hears(device)] if found else []

    def all_listening(self) -> list[Device]:
        """Return all devices that hear the host."""
        return [device for device in self.devices if self.hears(device)]

    def hears(self, device: Device) -> bool:
        """Return whether a device receives the host at its present baud rate and protocol."""
        mine, its = self._baud, device.baud
        same = its == mine or abs(its - mine) <= BAUD_TOLERANCE * mine
        if self.spoken is not None and device.protocol != self.spoken:
            return False
        return same and device.listens(self.schedule.now)

    def answer(self, data: bytes, baud: int, identifier: int) -> float:
        """Send a status packet now, with faults; return when it ends, s."""
        wrong = self.fault_injector
        if wrong is None:
            return self.put(data, baud)
        return wrong.answer(self, data, baud, identifier)

    def _noise(self, count: int) -> bytes:
        """Return random bytes, as received in a collision or at a wrong baud rate."""
        return self._dice.randbytes(count) if self.faults is None else self.faults.noise(count)

    def answers(self, data: Sequence[bytes]) -> None:
        """Send status packets without gaps and faults, at the host's baud rate."""
        self.put(b"".join(data), self._baud)

    def put(
        self, data: bytes, baud: int, received: bytes | None = None, held_until: float = 0.0
    ) -> float:
        """Send bytes of a device now; return when they end, s.

        Args:
            data: The bytes that the device sends.
            baud: Baud rate of the device.
            received: The bytes that the host receives instead, if a fault changed them.
            held_until: Time before which the host's adapter does not deliver them, s.
        """
        burst = Burst(self.schedule.now, BITS / baud, bytearray(data), held_until=held_until)
        end = burst.end
        self.counts["collisions"] += self._traffic.add(burst, self.schedule.now, self._noise)
        if received is not None:
            burst.data[:] = received
        if abs(baud - self._baud) > BAUD_TOLERANCE * self._baud:
            burst.data[:] = self._noise(len(burst.data))
        if burst.data and self.plugged:
            self.inbox.append(burst)
            if self.tap is not None:
                self.tap("<", baud, burst)
        return end

    def _execute_frame(self, item: ParsedItem, burst: Burst, end: float) -> None:
        """Execute a frame of the host, unless a collision has corrupted it since."""
        if end > burst.corrupted or not self.protocol.execute(item, self):
            self.counts["dropped"] += 1
            return
        self.counts["frames"] += 1
        self.last_instruction = end
