"""Which read a cycle of one bus sends: the state each time, and now and then more of a servo."""

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
"""Voltage and temperature are read every so many cycles, and every `CHECK_EVERY`-th time torque."""
CHECK_EVERY = 4
ALONE_EVERY = 5
"""Where one servo can be read further on than the others, it is another one's turn so often."""


Column = npt.NDArray[np.int64]


class Longer(NamedTuple):
    """What a read says of some servos beyond their state, as live views.

    Attributes:
        rows: The servos.
        volts: (rows,) counts of the voltage.
        degrees: (rows,) counts of the temperature.
        torque: Each register that says whether they drive, (rows,) counts, and what a restart
            leaves in it, -1 where that says nothing. Empty where none was read.
    """

    rows: slice
    volts: Column
    degrees: Column
    torque: tuple[tuple[Column, int], ...]

    @classmethod
    def of(cls, read: CyclicRead, rows: slice, begin: int, family: Family) -> "Longer":
        """Return what `read` will say of `rows`, which it reads from the address `begin` on."""

        def column(name: str) -> Column:
            register = family.registers[name]
            return read.column(register.address - begin, register.dtype, rows)

        torque: tuple[tuple[Column, int], ...] = ()
        if begin <= family.torque_span(0).address:
            marks = {family.mark.name: family.mark.restarted} if family.mark is not None else {}
            torque = tuple((column(name), marks.get(name, -1)) for name in family.torque)
        return cls(rows, column("present_voltage"), column("present_temperature"), torque)


class Asked(NamedTuple):
    """One of the reads of a line.

    Attributes:
        read: The read.
        state_at: Which bytes of its payload are the servos' state; None where they are its
            beginning.
        block: What is read of each servo.
        longer: What is read of some beyond that, or None.
    """

    read: CyclicRead
    state_at: npt.NDArray[np.intp] | None
    block: Block
    longer: Longer | None = None


class LineReads:
    """The reads of one line of servos, in turn.

    A cycle is one transaction: the common read of the family, the fast one where all servos know
    it, one read a servo where they know none. On a bus with an OpenCR it is a bulk read of servos
    and board. Now and then servos are read further on, to voltage and temperature, and from
    further ahead, where they say whether torque is on: one where the protocol lets a read differ
    between servos, else all.

    Attributes:
        broken_chain: Was somebody missing? In a fast answer all are silent behind a missing one:
            it is left alone until all are back.
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
        self._fast: Asked | None = None
        self._fast_health = self._health
        self._cycle = 0
        self.broken_chain = False

    def probe_fast(self) -> bool:
        """Use the fast read from now on if all servos know it."""
        if self._board is None and self._bus.probe_fast(self._ids):
            self._fast = self._plain(fast=True)
            if not self._bus.family.check_alone:
                self._fast_health = self._take_turns(fast=True)
        return self._fast is not None

    def next(self) -> Asked:
        """Return what this cycle asks, the first one before any."""
        self._cycle += 1
        fast = self._fast if not self.broken_chain else None
        if self._cycle % self._every:
            return fast or self._state
        health = self._health if fast is None else self._fast_health
        return health[self._cycle // self._every % len(health)]

    def health(self) -> Asked:
        """Return the read of all servos, state and health, that is no part of the cycle."""
        state, check = self._blocks.state, self._blocks.check
        end = check.address + check.size
        return self._of_all(Block(state.address, end - state.address, state.state), False)

    def _plain(self, fast: bool = False) -> Asked:
        block = self._blocks.state
        return Asked(self._read(self._spans(block), fast), None, block)

    def _take_turns(self, fast: bool = False) -> list[Asked]:
        """Return the longer reads, in the order in which they take turns."""
        health, check = self._blocks.health, self._blocks.check
        if health is None:
            return [self._alone(row) for row in range(len(self._ids))]
        short, long = (self._of_all(block, fast) for block in (health, check))
        return [short] * (CHECK_EVERY - 1) + [long]

    def _of_all(self, block: Block, fast: bool) -> Asked:
        """Return a read of all servos that reaches further than the state."""
        read = self._read(self._spans(block), fast)
        everybody = slice(0, len(self._ids))
        return Asked(read, None, block, Longer.of(read, everybody, block.address, self._bus.family))

    def _alone(self, row: int) -> Asked:
        """Return the read in which one servo is read from its torque to its temperature."""
        state, check = self._blocks.state, self._blocks.check
        spans = self._spans(state)
        spans[row] = check.span(self._ids[row])
        read, at = self._read(spans), _state_of(spans, state)
        longer = Longer.of(read, slice(row, row + 1), check.address, self._bus.family)
        return Asked(read, at, state, longer)

    def _spans(self, block: Block) -> list[Span]:
        return [block.span(id) for id in self._ids]

    def _read(self, spans: list[Span], fast: bool = False) -> CyclicRead:
        board = [self._board.span] if self._board is not None else []
        return self._bus.family.dialect.read([*spans, *board], fast)


def _state_of(spans: Sequence[Span], state: Block) -> npt.NDArray[Any]:
    """Return which bytes of a payload of uneven `spans` are the `state` of each."""
    starts = np.cumsum([0, *(span.size for span in spans[:-1])])
    ahead = np.array([state.address - span.address for span in spans])
    return ((starts + ahead)[:, None] + np.arange(state.size)).ravel()
