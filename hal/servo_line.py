"""The joints on one bus: which frames a cycle sends, and where in the arrays its answers go."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hal.bus import Bus
from hal.families.family import Block
from hal.imu.opencr import OpenCr
from hal.joints import Array, Mask
from hal.plausibility import Plausibility
from hal.protocols.cyclic import CyclicRead
from hal.protocols.protocol2 import Span
from hal.servo_model import ServoMount
from hal.units import gain_groups

HEALTH_EVERY = 10
"""Voltage and temperature are read every so many cycles."""
HEALTH = ("present_voltage", "present_temperature")

Rows = slice | npt.NDArray[np.intp]


class Asked(NamedTuple):
    """One of the reads of a line.

    Attributes:
        read: The read.
        state_at: Which bytes of its payload are the servos' state; None where they are its
            beginning.
        block: What is read of each servo.
        long: Rows read on to voltage and temperature, or None.
    """

    read: CyclicRead
    state_at: npt.NDArray[np.intp] | None
    block: Block
    long: slice | None = None


class ServoLine:
    """The servos of one bus within a robot of n joints.

    A cycle is one transaction: the common read of the family, the fast one where all servos know
    it, one read a servo where they know none. On a bus with an OpenCR it is a bulk read of servos
    and board. Now and then servos are read further on, to their voltage and temperature: one
    where the protocol lets a read differ between servos, else all.

    Attributes:
        bus: The bus.
        ids: Their ids.
        rows: Their joints' indices.
        mounts: How they sit.
        check: The plausibility of readings; None where nobody reads them.
        imu: The last bytes of the OpenCR, or None while there are none.
        imu_fresh: Did they come with the last answers?
        goals: Goal positions, counts.
        gains: How stiffness is set, on which rows, and the frames that do it.
    """

    def __init__(
        self,
        bus: Bus,
        mounts: Sequence[ServoMount],
        rows: Sequence[int],
        board: OpenCr | None = None,
        check: Plausibility | None = None,
    ) -> None:
        self.bus, self.mounts, self.check = bus, tuple(mounts), check
        self.ids = tuple(mount.id for mount in mounts)
        self.rows: npt.NDArray[np.intp] = np.array(rows, dtype=np.intp)
        # One bus in joint order is the rule, and a slice costs less than an index.
        whole = self.rows.tolist() == list(range(len(self.ids)))
        self._where: Rows = slice(len(self.ids)) if whole else self.rows
        self.board = board
        self.imu: bytes | None = None
        self.imu_fresh = False
        family = bus.family
        self.goals = family.dialect.write(self.ids, family.registers["goal_position"])
        self.gains = [
            (gain, at, family.dialect.write([self.ids[row] for row in at], gain.register))
            for gain, at in gain_groups(mounts)
        ]
        self._block, self._long_block = family.cycle([mount.model for mount in mounts])
        self._state = self._plain()
        self._health = self._health_reads()
        self._fast: Asked | None = None
        self._fast_health = self._health
        self._cycle = 0
        self._broken_chain = False
        self._asked = self._state

    def probe_fast(self) -> bool:
        """Use the fast read from now on if all servos know it."""
        if self.board is None and self.bus.probe_fast(self.ids):
            self._fast = self._plain(fast=True)
            if not self.bus.family.health_alone:
                self._fast_health = self._health_reads(fast=True)
        return self._fast is not None

    def request(self) -> None:
        """Ask all servos of the line, and the board."""
        self._cycle += 1
        fast = self._fast if not self._broken_chain else None
        if self._cycle % HEALTH_EVERY == 0:
            health = self._health if fast is None else self._fast_health
            self._asked = health[self._cycle // HEALTH_EVERY % len(health)]
        else:
            self._asked = fast or self._state
        self.bus.exchange.request(self._asked.read)

    def collect(self, counts: Array, health: Array, error: npt.NDArray[np.uint8]) -> Mask:
        """Take in the answers and return whose came, in the order of `rows`.

        Args:
            counts: (3, n) position, velocity and current of all joints; fresh ones are put there.
            health: (3, n) voltage V, temperature degrees C, and when they were read, s; the same.
            error: (n,) error bytes; the same.
        """
        asked, servos = self._asked, len(self.ids)
        answered = self.bus.exchange.collect()
        if not answered.size:
            return np.zeros(servos, dtype=bool)
        valid = answered[:servos]
        self.imu_fresh = self.board is not None and bool(answered[-1])
        if self.imu_fresh:
            self.imu = asked.read.params(servos)
        # In a fast answer all are silent behind a missing one: ask plainly until all are back.
        self._broken_chain = not asked.read.complete
        believed = self._put(asked, valid, counts, error)
        if asked.long is not None:
            self._take_health(asked, asked.long, believed, health)
        return believed

    def read_health(self, health: Array) -> None:
        """Read voltage and temperature of all servos into (3, n), as of `collect`, out of turn."""
        for row, name in enumerate(HEALTH):
            register = self.bus.family.registers[name]
            counts, valid = self.bus.sync_read(self.ids, register)
            health[row, self.rows[valid]] = counts[valid] * register.unit
            health[-1, self.rows[valid]] = self.bus.port.clock.now()

    def forget(self) -> None:
        """Take nothing for granted: servos may have been turned by hand, or be missing."""
        self._broken_chain = True
        if self.check is not None:
            self.check.forget()

    def _put(self, asked: Asked, valid: Mask, counts: Array, error: npt.NDArray[np.uint8]) -> Mask:
        read, block = asked.read, asked.block
        records = self._records(asked)
        position, velocity, effort = block.counts(records)
        errors = read.error[: len(self.ids)]
        complete = read.complete
        if self.check is not None:
            valid = self.check.accept(position, velocity, valid, self.bus.port.clock.now())
            complete = bool(valid.all())
            self.bus.exchange.errors["implausible"] = self.check.rejected
        rows: Rows = self._where
        if not complete:
            rows = self.rows[valid]
            position, velocity, effort = position[valid], velocity[valid], effort[valid]
            errors = errors[valid]
        counts[0, rows] = position
        counts[1, rows] = velocity
        counts[2, rows] = effort
        error[rows] = errors
        return valid

    def _records(self, asked: Asked) -> npt.NDArray[np.void]:
        """Return (servos,) records of the block."""
        payload, block = asked.read.payload, asked.block
        if asked.state_at is not None:
            payload = payload.take(asked.state_at)
        return payload[: len(self.ids) * block.size].view(block.dtype)

    def _take_health(self, asked: Asked, long: slice, valid: Mask, health: Array) -> None:
        """Put the voltage and temperature of the rows `long` where they belong."""
        fresh = valid[long]
        rows = self.rows[long][fresh]
        for row, name in enumerate(HEALTH):
            register = self.bus.family.registers[name]
            offset = register.address - self._block.address
            raw = asked.read.column(offset, register.dtype, long)
            health[row, rows] = raw[fresh] * register.unit
        health[-1, rows] = self.bus.port.clock.now()

    def _plain(self, fast: bool = False) -> Asked:
        return Asked(self._read(self._spans(self._block), fast), None, self._block)

    def _health_reads(self, fast: bool = False) -> list[Asked]:
        everybody = slice(0, len(self.ids))
        if not self.bus.family.health_alone:
            block = self._long_block
            return [Asked(self._read(self._spans(block), fast), None, block, everybody)]
        reads = []
        for row, id in enumerate(self.ids):
            spans = self._spans(self._block)
            spans[row] = self._long_block.span(id)
            at = _state_of(spans, self._block.size)
            reads.append(Asked(self._read(spans), at, self._block, slice(row, row + 1)))
        return reads

    def _spans(self, block: Block) -> list[Span]:
        return [block.span(id) for id in self.ids]

    def _read(self, spans: list[Span], fast: bool = False) -> CyclicRead:
        board = [self.board.span] if self.board is not None else []
        return self.bus.family.dialect.read([*spans, *board], fast)


def _state_of(spans: Sequence[Span], size: int) -> npt.NDArray[Any]:
    """Return which bytes of a payload of uneven `spans` are the first `size` of each."""
    sizes = [span.size for span in spans]
    starts = np.cumsum([0, *sizes[:-1]])
    return (starts[:, None] + np.arange(size)).ravel()
