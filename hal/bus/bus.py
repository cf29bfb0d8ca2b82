"""One servo bus: scan, single registers, and sync access to several servos."""

import contextlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from windup.hal.bus.transactions import BusTransactions
from windup.hal.errors import HardwareError, NoAnswerError, UsageError
from windup.hal.families import DYNAMIXEL_X, Family
from windup.hal.heartbeat import Heartbeat
from windup.hal.joints import Mask
from windup.hal.port.adapter import measure_adapter
from windup.hal.port.port import Port
from windup.hal.protocols.cyclic import CyclicRead
from windup.hal.protocols.protocol2 import Span, Status
from windup.hal.registers import Register

Counts = npt.NDArray[np.int64]

REBOOT_TIME = 0.6
"""Time for which a servo does not answer after a reboot, s."""
BEAT = 20e-3
"""Maximum time between two heartbeats during a wait, s."""
FIRST = (1,)
"""Ids that a scan probes to measure the adapter: 1, the factory default of most servos."""
EEPROM_TIME = 20e-3
"""Time that a Feetech servo needs to write its EEPROM after its status packet, s."""


class ScannedServo(NamedTuple):
    """A servo that answered a scan."""

    baud: int
    id: int
    model_number: int
    firmware: int
    model: str


class Bus:
    """The servos on one port, all of one family.

    `ping`, `read`, `write` and similar methods use the maker's SDK, wait for the answer, and retry;
    `sync_read` and `sync_write` are one transaction of this package. A control loop holds its own
    `CyclicRead` and `CyclicWrite` and uses `exchange` directly.

    Attributes:
        port: The port.
        family: Family of all servos on the bus.
        exchange: Cyclic transactions and error statistics.
        heartbeat: Called before every transaction except those made through `exchange` directly,
            and during `wait`; it feeds the watchdog of this program, if there is one.
    """

    def __init__(self, port: Port, family: Family = DYNAMIXEL_X) -> None:
        self.port, self.family = port, family
        self.exchange = BusTransactions(port)
        self._configurator = family.protocol.configurator(port)
        self._fast: dict[tuple[int, ...], bool] = {}

    def move_to(self, port: Port) -> None:
        """Continue on another port, as after replugging an adapter; statistics are kept.

        The latency and echo measured on the old port are assumed for the new one.
        """
        before = self.port
        port.echoes, port.is_measured = before.echoes, before.is_measured
        port.latency = max(port.latency, before.latency)
        self.port = port
        self.exchange.move_to(port)
        heartbeat, self._configurator = self.heartbeat, self.family.protocol.configurator(port)
        self.heartbeat = heartbeat

    @property
    def heartbeat(self) -> Heartbeat:
        """Heartbeat callback; the SDK wrapper also calls it before each attempt."""
        return self._configurator.heartbeat

    @heartbeat.setter
    def heartbeat(self, heartbeat: Heartbeat) -> None:
        self._configurator.heartbeat = heartbeat

    def measure_adapter(self, ids: Iterable[int]) -> None:
        """Measure the latency of the adapter, and whether it echoes requests.

        Args:
            ids: Ids of servos that may be present; the first that answers is probed several times.
        """
        probes = (self.family.protocol.probe(id) for id in ids)
        measure_adapter(self.port, probes, self.heartbeat)

    def ping(self, id: int) -> int:
        """Return the model number of servo `id`.

        Raises:
            NoAnswerError: The servo does not answer.
        """
        return self._configurator.ping(id)

    def scan(self, bauds: Iterable[int] | None = None) -> list[ScannedServo]:
        """Return every servo that answers at any of `bauds` (by default all of the family).

        The baud rate of the port is restored afterwards.
        """
        before = self.port.baud
        try:
            return [found for baud in bauds or self.family.bauds for found in self._scan(baud)]
        finally:
            self.port.baud = before

    def read(self, id: int, register: Register) -> int:
        """Return the value of one register, counts."""
        return register.decode(self._configurator.read(id, register.address, register.size))

    def write(self, id: int, register: Register, counts: int) -> None:
        """Write one register and read it back.

        Raises:
            HardwareError: The value read back differs.
        """
        self.command(id, register, counts, unlock=register.area == "eeprom")
        now = self.read(id, register)
        if now != counts:  # read again: the first answer may have been a late one
            self._configurator.settle()
            now = self.read(id, register)
        if now != counts:
            raise HardwareError(
                f"id {id} on {self.port.url}: {register.name} was set to {counts} "
                f"and reads back as {now}"
            )

    def command(self, id: int, register: Register, counts: int, unlock: bool = False) -> None:
        """Write one register without reading back; `unlock` unlocks the EEPROM for the write."""
        with self._unlocked(id, unlock):
            self._configurator.write(id, register.address, register.encode(counts))

    def sync_read(
        self, ids: Sequence[int], register: Register, fast: bool = False
    ) -> tuple[Counts, Mask]:
        """Return (n,) counts of one register, and (n,) bool: which servos answered.

        A plain sync read is the default: in a fast one, servos after a missing one are silent.
        """
        self.heartbeat()
        spans = [Span(id, register.address, register.size) for id in ids]
        read = self.family.protocol.read(spans, fast and self.fast(ids))
        self.exchange.request(read)
        valid = self.exchange.collect()
        return register.values(read.column(0, register.dtype)).astype(np.int64), valid

    def bulk_read(self, spans: Sequence[Span]) -> dict[int, bytes]:
        """Read a different span of each servo; return the bytes by id, of those that answered.

        One transaction in protocol 2 and on MX that passed `probe_fast`, else one per servo.
        """
        return {id: status.params for id, status in self.read_statuses(spans).items()}

    def read_statuses(self, spans: Sequence[Span], rest: bool = False) -> dict[int, Status]:
        """Return the status packets of a `bulk_read`; for `rest` see `BusTransactions.request`."""
        self.heartbeat()
        read = self.family.protocol.read(spans, self.fast([span.id for span in spans]))
        self.exchange.request(read, rest)
        if not (valid := self.exchange.collect()).size:
            return {}
        return {
            span.id: Status(span.id, int(read.error[row]), read.params(row))
            for row, span in enumerate(spans)
            if valid[row]
        }

    def sync_write(self, register: Register, counts: Mapping[int, int]) -> None:
        """Write one register of several servos at once, without answers: read back what matters."""
        data = {id: register.encode(value) for id, value in counts.items()}
        frames = self.family.protocol.sync_write(data, register.address, register.size)
        self.exchange.send(frames)

    def wait(self, seconds: float) -> None:
        """Wait on the port's clock, calling the heartbeat."""
        clock = self.port.clock
        until = clock.now() + seconds
        while (now := clock.now()) < until:
            self.heartbeat()
            clock.wait_until(min(now + BEAT, until))

    def fast(self, ids: Sequence[int]) -> bool:
        """Return whether `probe_fast` succeeded for these servos."""
        return self._fast.get(tuple(ids), False)

    def probe_fast(self, ids: Sequence[int]) -> bool:
        """Test whether all of `ids` support the fast read of their family, and return that.

        That is the fast sync read of X, the sync read of SCS, the bulk read of MX.
        An unpowered servo is silent too, so False is remembered only if the same servos answer
        the plain read.
        """
        spans = [Span(id, self.family.registers["id"].address, 1) for id in ids]
        if self._with_all_servos(self.family.protocol.read(spans, fast=True)):
            self._fast[tuple(ids)] = True
        elif self._with_all_servos(self.family.protocol.read(spans)):
            self._fast[tuple(ids)] = False
        return self.fast(ids)

    def reboot(self, id: int) -> None:
        """Reboot a servo (torque off, RAM registers at their defaults) and wait for its answer."""
        self._configurator.reboot(id)
        self.wait(REBOOT_TIME)
        self._configurator.ping(id)

    def set_id(self, id: int, new: int) -> None:
        """Change the id of a servo.

        Raises:
            UsageError: Another servo has the new id, or the id is out of range.
        """
        last = self.family.protocol.last_id
        if not 0 <= new <= last:
            raise UsageError(f"id {new} is invalid; ids are 0 to {last}")
        if self._answers(new):
            raise UsageError(
                f"id {new} on {self.port.url} belongs to another servo; give it a free id"
            )
        register = self.family.registers["id"]
        with self._unlocked(id, after=new):
            self._configurator.write(id, register.address, bytes([new]))
        self._configurator.ping(new)

    def set_baud(self, id: int, baud: int) -> None:
        """Change the baud rate of a servo and leave the port at that rate.

        Raises:
            UsageError: The family does not support this rate.
        """
        register, code = self.family.registers["baud_rate"], self.family.baud_code(baud)
        with self._unlocked(id):
            self._configurator.write(id, register.address, bytes([code]))
            self.port.baud = baud
        self._configurator.ping(id)

    def factory_reset(self, id: int, keep: int = 0x02) -> None:
        """Reset a servo; `keep`: 0xFF keeps nothing, 0x01 the id, 0x02 id and baud rate."""
        self._configurator.factory_reset(id, keep)
        self.wait(REBOOT_TIME)

    def _scan(self, baud: int) -> list[ScannedServo]:
        self.port.baud = baud
        self.measure_adapter(FIRST)
        return [
            ScannedServo(baud, *answered, self.family.model_name(answered.model_number))
            for answered in self.family.protocol.scan(self.port, self._configurator)
        ]

    @contextlib.contextmanager
    def _unlocked(self, id: int, unlock: bool = True, after: int | None = None) -> Iterator[None]:
        """Unlock the EEPROM of a Feetech servo for a write; lock it again, under the id `after`."""
        lock = self.family.registers.get("lock")
        if lock is None or not unlock:
            yield
            return
        self._configurator.write(id, lock.address, bytes([0]))
        try:
            yield
            self.wait(EEPROM_TIME)
        finally:
            self._configurator.write(id if after is None else after, lock.address, bytes([1]))

    def _with_all_servos(self, read: CyclicRead) -> bool:
        for _ in range(2):
            self.exchange.request(read)
            if self.exchange.collect().all():
                return True
        return False

    def _answers(self, id: int) -> bool:
        try:
            self._configurator.ping(id, attempts=1)
        except NoAnswerError:
            return False
        except HardwareError:
            return True
        return True
