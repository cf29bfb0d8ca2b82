"""One bus of servos: who is there, single registers, and several servos at once."""

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
from windup.hal.port.adapter import get_to_know
from windup.hal.port.port import Port
from windup.hal.protocols.cyclic import CyclicRead
from windup.hal.protocols.protocol2 import Span, Status
from windup.hal.registers import Register

Counts = npt.NDArray[np.int64]

REBOOT_TIME = 0.6
"""How long a servo is deaf after a reboot, s."""
BEAT = 20e-3
"""Longest time between two heartbeats while waiting, s."""
FIRST = (1,)
"""Whom a scan asks for the adapter's sake: the id that most servos leave the factory with."""
EEPROM_TIME = 20e-3
"""How long a Feetech servo writes its EEPROM after it has answered, s."""


class Found(NamedTuple):
    """A servo that answered a scan."""

    baud: int
    id: int
    model_number: int
    firmware: int
    model: str


class Bus:
    """The servos on one port, all of one family.

    `ping`, `read`, `write` and their like go through the maker's SDK, wait for the answer, and try
    again; `sync_read` and `sync_write` are one transaction of ours. A loop holds its own
    `CyclicRead` and `CyclicWrite` and drives `exchange` itself.

    Attributes:
        port: The port.
        family: Its servos.
        exchange: Its cyclic traffic and error statistics.
        heartbeat: Called before every transaction but those of the exchange itself, and while
            `wait` waits: somebody may be watching that this program lives.
    """

    def __init__(self, port: Port, family: Family = DYNAMIXEL_X) -> None:
        self.port, self.family = port, family
        self.exchange = BusTransactions(port)
        self._link = family.dialect.link(port)
        self._fast: dict[tuple[int, ...], bool] = {}

    def move_to(self, port: Port) -> None:
        """Go on over another port, as after an adapter was unplugged; statistics go on too.

        What was measured of the adapter is taken to be true of this one too.
        """
        before = self.port
        port.echoes, port.known = before.echoes, before.known
        port.latency = max(port.latency, before.latency)
        self.port = port
        self.exchange.move_to(port)
        heartbeat, self._link = self.heartbeat, self.family.dialect.link(port)
        self.heartbeat = heartbeat

    @property
    def heartbeat(self) -> Heartbeat:
        """What is called meanwhile; the maker's SDK calls it before each attempt."""
        return self._link.heartbeat

    @heartbeat.setter
    def heartbeat(self, heartbeat: Heartbeat) -> None:
        self._link.heartbeat = heartbeat

    def get_to_know_adapter(self, ids: Iterable[int]) -> None:
        """Measure how long the adapter holds answers back, and whether it gives requests back.

        Args:
            ids: Who may be there; the first that answers is asked a few times.
        """
        probes = (self.family.dialect.probe(id) for id in ids)
        get_to_know(self.port, probes, self.heartbeat)

    def ping(self, id: int) -> int:
        """Return the model number of servo `id`.

        Raises:
            NoAnswerError: Nobody answers.
        """
        return self._link.ping(id)

    def scan(self, bauds: Iterable[int] | None = None) -> list[Found]:
        """Return every servo that answers, at each of `bauds` (all by default).

        The port is left at the baud rate it had.
        """
        before = self.port.baud
        try:
            return [found for baud in bauds or self.family.bauds for found in self._scan(baud)]
        finally:
            self.port.baud = before

    def read(self, id: int, register: Register) -> int:
        """Return the counts in one register."""
        return register.decode(self._link.read(id, register.address, register.size))

    def write(self, id: int, register: Register, counts: int) -> None:
        """Write one register and read it back.

        Raises:
            HardwareError: It reads back as something else.
        """
        self.command(id, register, counts, unlock=register.area == "eeprom")
        now = self.read(id, register)
        if now != counts:  # not for an answer that came late
            self._link.settle()
            now = self.read(id, register)
        if now != counts:
            raise HardwareError(
                f"id {id} on {self.port.url}: {register.name} was set to {counts} "
                f"and reads back as {now}"
            )

    def command(self, id: int, register: Register, counts: int, unlock: bool = False) -> None:
        """Write what does not read back; `unlock` opens an EEPROM that has a lock."""
        with self._unlocked(id, unlock):
            self._link.write(id, register.address, register.encode(counts))

    def sync_read(
        self, ids: Sequence[int], register: Register, fast: bool = False
    ) -> tuple[Counts, Mask]:
        """Return (n,) counts of one register, and (n,) bool: whose are fresh.

        Plain by default: behind a missing servo a fast answer is silent.
        """
        self.heartbeat()
        spans = [Span(id, register.address, register.size) for id in ids]
        read = self.family.dialect.read(spans, fast and self.fast(ids))
        self.exchange.request(read)
        valid = self.exchange.collect()
        return register.values(read.column(0, register.dtype)).astype(np.int64), valid

    def bulk_read(self, spans: Sequence[Span]) -> dict[int, bytes]:
        """Return the bytes of other registers of each servo, by id, of those who answered.

        One transaction in protocol 2 and on MX that answered `probe_fast`, else one a servo.
        """
        return {id: status.params for id, status in self.statuses(spans).items()}

    def statuses(self, spans: Sequence[Span], rest: bool = False) -> dict[int, Status]:
        """Return the same with the error bytes of the answers; `rest` as of `request`."""
        self.heartbeat()
        read = self.family.dialect.read(spans, self.fast([span.id for span in spans]))
        self.exchange.request(read, rest)
        if not (valid := self.exchange.collect()).size:
            return {}
        return {
            span.id: Status(span.id, int(read.error[row]), read.params(row))
            for row, span in enumerate(spans)
            if valid[row]
        }

    def sync_write(self, register: Register, counts: Mapping[int, int]) -> None:
        """Write one register of several servos at once. Nobody answers: read back what matters."""
        data = {id: register.encode(value) for id, value in counts.items()}
        frames = self.family.dialect.sync_write(data, register.address, register.size)
        self.exchange.send(frames)

    def wait(self, seconds: float) -> None:
        """Let time pass."""
        clock = self.port.clock
        until = clock.now() + seconds
        while (now := clock.now()) < until:
            self.heartbeat()
            clock.wait_until(min(now + BEAT, until))

    def fast(self, ids: Sequence[int]) -> bool:
        """Return whether these servos answered `probe_fast`."""
        return self._fast.get(tuple(ids), False)

    def probe_fast(self, ids: Sequence[int]) -> bool:
        """Find out whether all of `ids` know the fast read of their family.

        That is the fast sync read, the sync read of SCS, the bulk read of MX.
        Silence proves nothing about a servo without power: False is remembered only when the
        same servos answer the plain one.
        """
        spans = [Span(id, self.family.registers["id"].address, 1) for id in ids]
        if self._everybody(self.family.dialect.read(spans, fast=True)):
            self._fast[tuple(ids)] = True
        elif self._everybody(self.family.dialect.read(spans)):
            self._fast[tuple(ids)] = False
        return self.fast(ids)

    def reboot(self, id: int) -> None:
        """Restart a servo (torque off, RAM registers at their defaults) and wait for it."""
        self._link.reboot(id)
        self.wait(REBOOT_TIME)
        self._link.ping(id)

    def set_id(self, id: int, new: int) -> None:
        """Give a servo another id.

        Raises:
            UsageError: Somebody has it already, or there is no such id.
        """
        last = self.family.dialect.last_id
        if not 0 <= new <= last:
            raise UsageError(f"id {new} cannot be; ids go from 0 to {last}")
        if self._answers(new):
            raise UsageError(f"id {new} on {self.port.url} is taken; two servos cannot share it")
        register = self.family.registers["id"]
        with self._unlocked(id, after=new):
            self._link.write(id, register.address, bytes([new]))
        self._link.ping(new)

    def set_baud(self, id: int, baud: int) -> None:
        """Give a servo another baud rate and leave the port at that rate.

        Raises:
            UsageError: No servo of the family has this rate.
        """
        register, code = self.family.registers["baud_rate"], self.family.baud_code(baud)
        with self._unlocked(id):
            self._link.write(id, register.address, bytes([code]))
            self.port.baud = baud
        self._link.ping(id)

    def factory_reset(self, id: int, keep: int = 0x02) -> None:
        """Reset a servo; `keep` 0xFF nothing, 0x01 the id, 0x02 id and baud rate."""
        self._link.factory_reset(id, keep)
        self.wait(REBOOT_TIME)

    def _scan(self, baud: int) -> list[Found]:
        self.port.baud = baud
        self.get_to_know_adapter(FIRST)
        return [
            Found(baud, *answered, self.family.model_name(answered.model_number))
            for answered in self.family.dialect.who(self.port, self._link)
        ]

    @contextlib.contextmanager
    def _unlocked(self, id: int, unlock: bool = True, after: int | None = None) -> Iterator[None]:
        """Open the EEPROM of a Feetech servo for a write, and close it under the id `after`."""
        lock = self.family.registers.get("lock")
        if lock is None or not unlock:
            yield
            return
        self._link.write(id, lock.address, bytes([0]))
        try:
            yield
            self.wait(EEPROM_TIME)
        finally:
            self._link.write(id if after is None else after, lock.address, bytes([1]))

    def _everybody(self, read: CyclicRead) -> bool:
        for _ in range(2):
            self.exchange.request(read)
            if self.exchange.collect().all():
                return True
        return False

    def _answers(self, id: int) -> bool:
        try:
            self._link.ping(id, attempts=1)
        except NoAnswerError:
            return False
        except HardwareError:
            return True
        return True
