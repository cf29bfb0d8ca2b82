"""A half-duplex bus: bytes in time, at a baud rate, from one sender at a time.

What two senders say at the same time is noise for everybody. A device hears the host only at its
own baud rate, and the other way round.
"""

import math
import random
from collections.abc import Callable, Sequence
from functools import partial
from typing import Protocol

from windup.sim_twin.wire.bus.air import Air
from windup.sim_twin.wire.bus.heard import Heard
from windup.sim_twin.wire.bus.inbox import Burst, Inbox
from windup.sim_twin.wire.bus.timing import Timing
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.imu.bno055 import Bno055Registers
from windup.sim_twin.wire.imu.imu_faults import FaultyImu
from windup.sim_twin.wire.schedule import Schedule

BITS = 10  # start, eight, stop
FORGET = 0.1  # s; a frame that has been interrupted for longer is forgotten
BAUD_TOLERANCE = 0.03
PIECE = 4096  # bytes of the host that are taken apart together


class Language(Protocol):
    """A protocol: how bytes become frames, and what devices do with a frame.

    Attributes:
        id_at: Where a frame has its id.
        length_at: Where it has its length, the low byte.
        data_at: Where a status has its data.
        tail: Bytes of its checksum.
    """

    id_at: int
    length_at: int
    data_at: int
    tail: int

    def seal(self, frame: bytes, /) -> bytes:
        """Return `frame` with the checksum that it should have."""
        ...

    def meet(self, devices: Sequence[Device], /) -> None:
        """Take note of who is on the bus; called whenever registers below 64 may have changed."""
        ...

    def feed(self, chunk: bytes) -> list[Heard]:
        """Return the frames that end in `chunk`."""
        ...

    def reset(self) -> None:
        """Forget a frame that has begun."""
        ...

    def execute(self, frame: Heard, bus: "Bus") -> bool:
        """Do what a frame says; False if it was dropped."""
        ...


class Disturbance(Protocol):
    """What goes wrong on a bus.

    Attributes:
        active: Whether there is anything to go wrong.
    """

    active: bool

    def answer(self, bus: "Bus", data: bytes, baud: int, identifier: int) -> float:
        """Put an answer on the wire with what goes wrong now; return when it ends, s."""
        ...

    def asked(self, bus: "Bus") -> bool:
        """Whether the adapter gives the host back what it sends now."""
        ...

    def noise(self, count: int) -> bytes:
        """Return bytes as of a collision or a wrong baud rate."""
        ...


class Bus:
    """One bus and its host side.

    Attributes:
        name: Its name.
        devices: What hangs on it. Call `refresh` after changing ids from outside.
        baud: Baud rate of the host.
        schedule: The world's.
        timing: Latencies.
        faults: What goes wrong; the world sets it.
        heard: When the last good instruction ended, s.
        began: When the last bytes of the host began, s.
        counts: "frames" executed, "dropped", "collisions".
        plugged: Whether the host's adapter is there.
        plugs: How often it has been pulled out or put in.
        spoken: The protocol of the frame that is being executed: who speaks another one does not
            hear it. None: all devices speak the same.
        imu: The IMU that a board on it reports, or that sends on it by itself.
        chip: The chip that the IMU is where this is an I2C bus, which carries no bytes of servos.
        tap: Called with the direction (">" from the host), the baud rate and each burst of bytes.
    """

    def __init__(
        self,
        name: str,
        devices: list[Device],
        language: Language,
        schedule: Schedule,
        baud: int = 1_000_000,
        timing: Timing | None = None,
    ) -> None:
        self.name, self.devices, self.language, self.schedule = name, devices, language, schedule
        self.timing = timing or Timing()
        self.faults: Disturbance | None = None
        self.heard = self.began = 0.0
        self.counts = {"frames": 0, "dropped": 0, "collisions": 0}
        self.plugged, self.plugs = True, 0
        self.spoken: int | None = None
        self.imu: FaultyImu | None = None
        self.chip: Bno055Registers | None = None
        self.tap: Callable[[str, int, Burst], None] | None = None
        self._dice = random.Random(0)
        self._baud = baud
        self._sent = -math.inf  # when the host's last byte ends
        self._out = -math.inf  # until when the adapter is pulled out
        self._air = Air()
        self.inbox = Inbox(self.timing.latency)
        self._by_id: dict[int, list[Device]] = {}
        self.refresh()

    @property
    def disturbance(self) -> Disturbance | None:
        """What goes wrong now, if anything."""
        return self.faults if self.faults is not None and self.faults.active else None

    @property
    def baud(self) -> int:
        """Baud rate of the host."""
        return self._baud

    @baud.setter
    def baud(self, baud: int) -> None:
        if baud != self._baud:
            self._baud = baud
            self.language.reset()

    def refresh(self) -> None:
        """Look up again who has which id, and who speaks what."""
        self.language.meet(self.devices)
        self._by_id.clear()
        for device in self.devices:
            self._by_id.setdefault(device.identifier, []).append(device)
            if device.shadow < 253 and device.shadow != device.identifier:
                self._by_id.setdefault(device.shadow, []).append(device)

    # The host's side

    def write(self, data: bytes) -> None:
        """Send bytes, now or behind those that are still going out."""
        start = max(self.schedule.now, self._sent)
        if start - self._sent > FORGET:
            self.language.reset()
        burst = Burst(start, BITS / self._baud, bytearray(data))
        self._sent, self.began = burst.end, start
        self.counts["collisions"] += self._air.add(burst, self.schedule.now, self._noise)
        if self.tap is not None:
            self.tap(">", self._baud, burst)
        wrong = self.disturbance
        if wrong is not None and wrong.asked(self) and self.plugged:
            self.inbox.append(Burst(burst.start, burst.byte, bytearray(burst.data)))
        for at in range(0, len(burst.data), PIECE):
            for item in self.language.feed(bytes(burst.data[at : at + PIECE])):
                if item.noise:
                    self.language.execute(item, self)
                    self.counts["dropped"] += 1
                    continue
                end = start + (at + item.end) * burst.byte
                self.schedule.at(end, partial(self._hear, item, burst, end))

    @property
    def backlog(self) -> float:
        """Until when the host's bytes keep the wire busy, s from now."""
        return max(self._sent - self.schedule.now, 0.0)

    def available(self) -> int:
        """Return the number of bytes that the host has got and not read."""
        return self.inbox.available(self.schedule.now)

    def arrival(self, count: int) -> float:
        """Return when the host has `count` bytes, s; infinity if they are not on the way yet."""
        return self.inbox.arrival(count)

    def read(self, count: int) -> bytes:
        """Return up to `count` bytes that have arrived."""
        return self.inbox.read(count, self.schedule.now)

    @property
    def queued(self) -> int:
        """Bytes that the host has not read, arrived or on the way."""
        return self.inbox.queued

    def discard(self) -> None:
        """Throw away what has arrived and was not read."""
        self.read(self.available())

    def plug(self, there: bool) -> None:
        """Pull the host's adapter out, or put it in again; open ports stay dead all the same."""
        if there != self.plugged:
            self.plugged = there
            self.plugs += 1
            self.inbox.clear()
            self.language.reset()

    def unplug(self, seconds: float) -> None:
        """Pull the adapter out, and put it in again after some seconds (infinity: never)."""
        self.plug(False)
        back = self.schedule.now + seconds
        self._out = max(self._out, back)
        if back < math.inf:
            self.schedule.at(back, self._plug_in)

    def _plug_in(self) -> None:
        if self.schedule.now >= self._out:  # it was not pulled out for longer since
            self.plug(True)

    # The devices' side

    def listeners(self, identifier: int) -> list[Device]:
        """Return who hears the host and has this id, or has it as a shadow."""
        found = self._by_id.get(identifier)
        return [device for device in found if self.hears(device)] if found else []

    def everybody(self) -> list[Device]:
        """Return who hears the host."""
        return [device for device in self.devices if self.hears(device)]

    def hears(self, device: Device) -> bool:
        """Whether a device understands what the host sends now."""
        mine, its = self._baud, device.baud
        same = its == mine or abs(its - mine) <= BAUD_TOLERANCE * mine
        if self.spoken is not None and device.protocol != self.spoken:
            return False
        return same and device.listens(self.schedule.now)

    def answer(self, data: bytes, baud: int, identifier: int) -> float:
        """Put an answer on the wire, now; return when it ends, s."""
        wrong = self.disturbance
        if wrong is None:
            return self.put(data, baud)
        return wrong.answer(self, data, baud, identifier)

    def _noise(self, count: int) -> bytes:
        """Return bytes as of a collision or a wrong baud rate."""
        return self._dice.randbytes(count) if self.faults is None else self.faults.noise(count)

    def answers(self, data: Sequence[bytes]) -> None:
        """Put answers on the wire, without gaps and faults, at the host's baud rate."""
        self.put(b"".join(data), self._baud)

    def put(self, data: bytes, baud: int, got: bytes | None = None, held: float = 0.0) -> float:
        """Put bytes of a device on the wire, now; return when they end, s.

        Args:
            data: What the device sends.
            baud: How fast.
            got: What the host gets of it, where that is something else.
            held: Before when the host's adapter does not give it away, s.
        """
        burst = Burst(self.schedule.now, BITS / baud, bytearray(data), held=held)
        end = burst.end
        self.counts["collisions"] += self._air.add(burst, self.schedule.now, self._noise)
        if got is not None:
            burst.data[:] = got
        if abs(baud - self._baud) > BAUD_TOLERANCE * self._baud:
            burst.data[:] = self._noise(len(burst.data))
        if burst.data and self.plugged:
            self.inbox.append(burst)
            if self.tap is not None:
                self.tap("<", baud, burst)
        return end

    def _hear(self, item: Heard, burst: Burst, end: float) -> None:
        """Execute a frame of the host, unless a collision has ruined it since."""
        if end > burst.ruined or not self.language.execute(item, self):
            self.counts["dropped"] += 1
            return
        self.counts["frames"] += 1
        self.heard = end
