"""Selects the read of each cycle of a bus: the state, or periodically a longer one with health."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from windup.hal.bus.bus import Bus
from windup.hal.families.family import Block, Family
from windup.hal.imu.opencr import OpenCr
from windup.hal.protocols.cyclic import CyclicRead
from windup.hal.protocols.protocol2 import Span
from windup.hal.servos.servo_model import ServoModel

HEALTH_EVERY = 10
"""Period of reads with voltage and temperature, cycles."""
CHECK_EVERY = 4
"""Period of reads that include torque, in units of `HEALTH_EVERY` cycles."""
ALONE_EVERY = 5
"""Period of longer reads of one servo each, in turn, if the family allows it, cycles."""


Column = npt.NDArray[np.int64]


class ExtraViews(NamedTuple):
    """Live views of the data that a read contains beyond the state, for some servos.

    Attributes:
        rows: Rows of the servos.
        volts: (rows,) voltage, counts.
        degrees: (rows,) temperature, counts.
        torque: For each torque register, its (rows,) counts and its value after a restart (-1 if
            it does not detect restarts). Empty if they are not read.
    """

    rows: slice
    volts: Column
    degrees: Column
    torque: tuple[tuple[Column, int], ...]

    @classmethod
    def of(cls, read: CyclicRead, rows: slice, begin: int, family: Family) -> "ExtraViews":
        """Return the views of `rows` in `read`, which reads them from the address `begin` on."""

        def column(name: str) -> Column:
            register = family.registers[name]
            return read.column(register.address - begin, register.dtype, rows)

        torque: tuple[tuple[Column, int], ...] = ()
        if begin <= family.torque_span(0).address:
            mark = family.restart_mark
            marks = {} if mark is None else {mark.name: mark.restarted}
            torque = tuple((column(name), marks.get(name, -1)) for name in family.torque)
        return cls(rows, column("present_voltage"), column("present_temperature"), torque)


class CycleRead(NamedTuple):
    """One of the reads of a bus.

    Attributes:
        read: The read.
        state_at: Indices of the bytes of its payload that contain the servos' states; None if
            they are its first bytes.
        block: The block read of each servo.
        extra: Views of further data of some servos, or None.
    """

    read: CyclicRead
    state_at: npt.NDArray[np.intp] | None
    block: Block
    extra: ExtraViews | None = None


class BusReads:
    """The reads of the servos of one bus, one per cycle.

    A cycle is one transaction: the common read of the family, the fast one if all servos support
    it, or one read per servo if they support none. On a bus with an OpenCR it is a bulk read of
    servos and board. Periodically a longer span is read, with voltage and temperature, and with
    the torque registers before the state: of one servo if the protocol allows different spans per
    servo, else of all.

    Attributes:
        broken_chain: Whether a servo is missing. In a fast read all servos after a missing one are
            silent, so it is not used until all answer again.
    """

    def __init__(
        self, bus: Bus, ids: Sequence[int], models: Sequence[ServoModel], board: OpenCr | None
    ) -> None:
        self._bus, self._ids, self._board = bus, tuple(ids), board
        family = bus.family
        self._blocks = family.cycle(models)
        self._every = ALONE_EVERY if family.check_alone else HEALTH_EVERY
        self._state = self._plain()
        self._health = self._take_turns()
        self._fast: CycleRead | None = None
        self._fast_health = self._health
        self._cycle = 0
        self.broken_chain = False

    def probe_fast(self) -> bool:
        """Use the fast read from now on if all servos support it; return whether they do."""
        if self._board is None and self._bus.probe_fast(self._ids):
            self._fast = self._plain(fast=True)
            if not self._bus.family.check_alone:
                self._fast_health = self._take_turns(fast=True)
        return self._fast is not None

    def next(self) -> CycleRead:
        """Return the read of the next cycle."""
        self._cycle += 1
        fast = self._fast if not self.broken_chain else None
        if self._cycle % self._every:
            return fast or self._state
        health = self._health if fast is None else self._fast_health
        return health[self._cycle // self._every % len(health)]

    def health(self) -> CycleRead:
        """Return a read of state and health of all servos, for use outside the cycle."""
        state, check = self._blocks.state, self._blocks.check
        end = check.address + check.size
        return self._of_all(Block(state.address, end - state.address, state.state), False)

    def _plain(self, fast: bool = False) -> CycleRead:
        block = self._blocks.state
        return CycleRead(self._read(self._spans(block), fast), None, block)

    def _take_turns(self, fast: bool = False) -> list[CycleRead]:
        """Return the longer reads, in the order of their use."""
        health, check = self._blocks.health, self._blocks.check
        if health is None:
            return [self._alone(row) for row in range(len(self._ids))]
        short, long = (self._of_all(block, fast) for block in (health, check))
        return [short] * (CHECK_EVERY - 1) + [long]

    def _of_all(self, block: Block, fast: bool) -> CycleRead:
        """Return a read of all servos with a `block` longer than the state."""
        read = self._read(self._spans(block), fast)
        everybody = slice(0, len(self._ids))
        return CycleRead(
            read, None, block, ExtraViews.of(read, everybody, block.address, self._bus.family)
        )

    def _alone(self, row: int) -> CycleRead:
        """Return a read in which one servo is read from its torque to its temperature registers."""
        state, check = self._blocks.state, self._blocks.check
        spans = self._spans(state)
        spans[row] = check.span(self._ids[row])
        read, at = self._read(spans), _state_of(spans, state)
        extra = ExtraViews.of(read, slice(row, row + 1), check.address, self._bus.family)
        return CycleRead(read, at, state, extra)

    def _spans(self, block: Block) -> list[Span]:
        return [block.span(id) for id in self._ids]

    def _read(self, spans: list[Span], fast: bool = False) -> CyclicRead:
        board = [self._board.span] if self._board is not None else []
        return self._bus.family.protocol.read([*spans, *board], fast)


def _state_of(spans: Sequence[Span], state: Block) -> npt.NDArray[Any]:
    """Return the indices of the bytes of each servo's `state` in a payload of uneven `spans`."""
    starts = np.cumsum([0, *(span.size for span in spans[:-1])])
    ahead = np.array([state.address - span.address for span in spans])
    return ((starts + ahead)[:, None] + np.arange(state.size)).ravel()
