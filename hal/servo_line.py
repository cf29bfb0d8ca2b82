"""The joints on one bus: which frames a cycle sends, and where in the arrays its answers go."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hal.bus import Bus
from hal.imu.opencr import OpenCr
from hal.joints import Array, Mask
from hal.protocols.batched import BlockRead, BlockWrite
from hal.protocols.protocol2 import Span
from hal.servos.x_series_registers import COMMON

STATE = Span(0, 126, 10)
"""Current or load, velocity, position: one run of registers, the same in the whole family."""
STATE_TYPE = np.dtype([("current", "<i2"), ("velocity", "<i4"), ("position", "<i4")])
HEALTH = Span(0, 126, 21)
"""The same, on to voltage and temperature."""
HEALTH_EVERY = 10
"""One servo's voltage and temperature are read every so many cycles."""

Rows = slice | npt.NDArray[np.intp]
LAST_CODE = 127
"""Largest error byte without the alert bit."""

REGISTERS = {register.name: register for register in COMMON}


class ServoLine:
    """The servos of one bus within a robot of n joints.

    A cycle is one transaction. On a bus with an OpenCR it is a bulk read of servos and board; else
    a sync read, fast where all servos know it. Now and then one servo is read further on, to its
    voltage and temperature.

    Attributes:
        bus: The bus.
        ids: Their ids.
        rows: Their joints' indices.
        imu: The last bytes of the OpenCR, or None while there are none.
        imu_fresh: Did they come with the last answers?
        goals: Goal positions, counts.
        gains: P registers.
    """

    def __init__(
        self, bus: Bus, ids: Sequence[int], rows: Sequence[int], board: OpenCr | None = None
    ) -> None:
        self.bus, self.ids = bus, tuple(ids)
        self.rows: npt.NDArray[np.intp] = np.array(rows, dtype=np.intp)
        # One bus in joint order is the rule, and a slice costs less than an index.
        whole = self.rows.tolist() == list(range(len(self.ids)))
        self._where: Rows = slice(len(self.ids)) if whole else self.rows
        self.board = board
        self.imu: bytes | None = None
        self.imu_fresh = False
        goal, gain = REGISTERS["goal_position"], REGISTERS["position_p_gain"]
        self.goals = BlockWrite(self.ids, goal.address, goal.size)
        self.gains = BlockWrite(self.ids, gain.address, gain.size)
        self._state = _read(self.ids, board)
        self._fast: BlockRead | None = None
        self._health = [_read(self.ids, board, row) for row in range(len(self.ids))]
        self._cycle = 0
        self._broken_chain = False
        self._asked = self._state
        self._long: int | None = None
        """Row that is read on to its voltage and temperature in this cycle."""

    def probe_fast(self) -> bool:
        """Use the fast sync read from now on if all servos know it."""
        if self.board is None and self.bus.probe_fast(self.ids):
            self._fast = _read(self.ids, None, fast=True)
        return self._fast is not None

    def request(self) -> None:
        """Ask all servos of the line, and the board."""
        self._cycle += 1
        self._long = None
        if self._cycle % HEALTH_EVERY == 0:
            self._long = self._cycle // HEALTH_EVERY % len(self.ids)
            self._asked = self._health[self._long]
        elif self._fast is not None and not self._broken_chain:
            self._asked = self._fast
        else:
            self._asked = self._state
        self.bus.exchange.request(self._asked)

    def collect(self, counts: Array, health: Array, alert: Mask) -> Mask:
        """Take in the answers and return whose came, in the order of `rows`.

        Args:
            counts: (3, n) position, velocity and current of all joints; fresh ones are put there.
            health: (2, n) voltage V and temperature degrees C; the same.
            alert: (n,) bool, who signals a hardware error; the same.
        """
        read, servos = self._asked, len(self.ids)
        answered = self.bus.exchange.collect()
        if not answered.size:
            return np.zeros(servos, dtype=bool)
        valid = answered[:servos]
        self.imu_fresh = self.board is not None and bool(answered[-1])
        if self.imu_fresh:
            self.imu = read.params(servos)
        # In a fast answer all are silent behind a missing one: ask plainly until all are back.
        self._broken_chain = not read.complete
        self._put(read, valid, counts, alert)
        if self._long is not None and valid[self._long]:
            self._take_health(read, self._long, health)
        return valid

    def _put(self, read: BlockRead, valid: Mask, counts: Array, alert: Mask) -> None:
        state, error = self._fields(read), read.error[: len(self.ids)]
        rows: Rows = self._where
        if not read.complete:
            rows, state, error = self.rows[valid], state[valid], error[valid]
        counts[0, rows] = state["position"]
        counts[1, rows] = state["velocity"]
        counts[2, rows] = state["current"]
        alert[rows] = error > LAST_CODE

    def _fields(self, read: BlockRead) -> npt.NDArray[np.void]:
        """Return (servos,) records of `STATE_TYPE`."""
        payload = read.payload
        if self._long is not None:
            payload = payload.take(self._state_of(read))
        return payload[: len(self.ids) * STATE.size].view(STATE_TYPE)

    def _state_of(self, read: BlockRead) -> npt.NDArray[np.intp]:
        sizes = [span.size for span in read.spans[: len(self.ids)]]
        starts = np.cumsum([0, *sizes[:-1]])
        return (starts[:, None] + np.arange(STATE.size)).ravel()

    def _take_health(self, read: BlockRead, row: int, health: Array) -> None:
        data = read.params(row)
        voltage, temperature = REGISTERS["present_voltage"], REGISTERS["present_temperature"]
        start = voltage.address - HEALTH.address
        volts = voltage.decode(data[start : start + voltage.size]) * voltage.unit
        health[:, self.rows[row]] = volts, data[temperature.address - HEALTH.address]


def _read(
    ids: Sequence[int], board: OpenCr | None, long_row: int | None = None, fast: bool = False
) -> BlockRead:
    """Return the cyclic read of `ids`; the servo at `long_row` is read on to its temperature."""
    spans = [
        Span(id, STATE.address, HEALTH.size if row == long_row else STATE.size)
        for row, id in enumerate(ids)
    ]
    return BlockRead([*spans, *([board.span] if board is not None else [])], fast)
