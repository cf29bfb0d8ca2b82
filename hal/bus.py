"""One bus of Dynamixel servos: who is there, single registers, and several servos at once."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hal.errors import HardwareError, NoAnswerError, UsageError
from hal.exchange import Exchange
from hal.joints import Mask
from hal.port import Port
from hal.protocols import protocol2
from hal.protocols.batched import BlockRead
from hal.protocols.protocol2 import Span
from hal.registers import Register
from hal.sdk import DynamixelLink
from hal.servos.x_series_registers import BAUD_CODES, COMMON, model_name

Counts = npt.NDArray[np.int64]

PING_SLOT = 3e-3
"""Servos answer a broadcast ping one after the other, each id in its own slot of this, s."""
REBOOT_TIME = 0.6
"""How long a servo is deaf after a reboot, s."""

_TABLE = {register.name: register for register in COMMON}


class Found(NamedTuple):
    """A servo that answered a scan."""

    baud: int
    id: int
    model_number: int
    firmware: int

    @property
    def model(self) -> str:
        """The name of its model."""
        return model_name(self.model_number)


class Bus:
    """The servos on one port.

    `ping`, `read`, `write` and their like go through dynamixel-sdk, wait for the answer, and try
    again; `sync_read` and `sync_write` are one transaction of ours. A loop holds its own
    `BlockRead` and `BlockWrite` and drives `exchange` itself.

    Attributes:
        port: The port.
        exchange: Its cyclic traffic and error statistics.
    """

    def __init__(self, port: Port) -> None:
        self.port = port
        self.exchange = Exchange(port)
        self._link = DynamixelLink(port)
        self._fast: dict[tuple[int, ...], bool] = {}

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
            return [found for baud in bauds or BAUD_CODES for found in self._scan(baud)]
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
        self._link.write(id, register.address, register.encode(counts))
        if (now := self.read(id, register)) != counts:
            raise HardwareError(
                f"id {id} on {self.port.url}: {register.name} was set to {counts} "
                f"and reads back as {now}"
            )

    def sync_read(
        self, ids: Sequence[int], register: Register, fast: bool = False
    ) -> tuple[Counts, Mask]:
        """Return (n,) counts of one register, and (n,) bool: whose are fresh.

        Plain by default: behind a missing servo a fast answer is silent.
        """
        spans = [Span(id, register.address, register.size) for id in ids]
        read = BlockRead(spans, fast=fast and self.fast(ids))
        self.exchange.request(read)
        valid = self.exchange.collect()
        kind = f"<{'i' if register.signed else 'u'}{register.size}"
        return read.column(0, kind).astype(np.int64), valid

    def bulk_read(self, spans: Sequence[Span]) -> dict[int, bytes]:
        """Return the bytes of other registers of each servo, by id, of those who answered."""
        read = BlockRead(spans)
        self.exchange.request(read)
        valid = self.exchange.collect()
        return {span.id: read.params(row) for row, span in enumerate(spans) if valid[row]}

    def sync_write(self, register: Register, counts: Mapping[int, int]) -> None:
        """Write one register of several servos at once. Nobody answers: read back what matters."""
        data = {id: register.encode(value) for id, value in counts.items()}
        self.exchange.send([protocol2.sync_write(data, register.address, register.size)])

    def fast(self, ids: Sequence[int]) -> bool:
        """Return whether these servos answered `probe_fast`."""
        return self._fast.get(tuple(ids), False)

    def probe_fast(self, ids: Sequence[int]) -> bool:
        """Find out whether all of `ids` know the fast sync read.

        Silence proves nothing about a servo without power: False is remembered only when the
        same servos answer the plain one.
        """
        spans = [Span(id, _TABLE["id"].address, 1) for id in ids]
        if self._everybody(BlockRead(spans, fast=True)):
            self._fast[tuple(ids)] = True
        elif self._everybody(BlockRead(spans)):
            self._fast[tuple(ids)] = False
        return self.fast(ids)

    def reboot(self, id: int) -> None:
        """Restart a servo (torque off, RAM registers at their defaults) and wait for it."""
        self._link.reboot(id)
        self._wait(REBOOT_TIME)
        self._link.ping(id)

    def set_id(self, id: int, new: int) -> None:
        """Give a servo another id.

        Raises:
            UsageError: Somebody has it already, or there is no such id.
        """
        if not 0 <= new <= protocol2.LAST_ID:
            raise UsageError(f"id {new} cannot be; ids go from 0 to {protocol2.LAST_ID}")
        if self._answers(new):
            raise UsageError(f"id {new} on {self.port.url} is taken; two servos cannot share it")
        self._link.write(id, _TABLE["id"].address, bytes([new]))
        self._link.ping(new)

    def set_baud(self, id: int, baud: int) -> None:
        """Give a servo another baud rate and leave the port at that rate.

        Raises:
            UsageError: No servo of the family has this rate.
        """
        if baud not in BAUD_CODES:
            rates = ", ".join(str(rate) for rate in BAUD_CODES)
            raise UsageError(f"baud rate {baud} cannot be; there are {rates}")
        self._link.write(id, _TABLE["baud_rate"].address, bytes([BAUD_CODES[baud]]))
        self.port.baud = baud
        self._link.ping(id)

    def factory_reset(self, id: int, keep: int = 0x02) -> None:
        """Reset a servo; `keep` 0xFF nothing, 0x01 the id, 0x02 id and baud rate."""
        self._link.factory_reset(id, keep)
        self._wait(REBOOT_TIME)

    def _scan(self, baud: int) -> list[Found]:
        """Ping everybody at one baud rate; every reply that is whole counts."""
        self.port.baud = baud
        self.port.flush_input()
        self.port.write(protocol2.ping())
        slots = PING_SLOT * protocol2.LAST_ID + 2.0 * self.port.latency
        longest = (protocol2.LAST_ID + 1) * (protocol2.OVERHEAD + 3)
        stream = self.port.read(longest, self.port.clock.now() + slots + longest * 10.0 / baud)
        answers = {item.id: item.params for item in protocol2.salvage(stream)}
        return [
            Found(baud, id, int.from_bytes(params[:2], "little"), params[2])
            for id, params in sorted(answers.items())
            if len(params) == 3
        ]

    def _everybody(self, read: BlockRead) -> bool:
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

    def _wait(self, seconds: float) -> None:
        self.port.clock.wait_until(self.port.clock.now() + seconds)
