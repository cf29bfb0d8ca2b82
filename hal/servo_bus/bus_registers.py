"""Register access to the servos of one bus: written to several, read back, and retried."""

from collections.abc import Sequence
from shlex import quote

import numpy as np
import numpy.typing as npt

from windup.hal.errors import HardwareError
from windup.hal.joints import Array, Mask
from windup.hal.registers import Register
from windup.hal.servo_bus.bus_readout import BusReadout, Rows

ATTEMPTS = 8
BACKOFF = 4e-3
"""Increase of the pause before each further attempt, s: adapters may delay answers by 16 ms."""


class BusRegisters:
    """Reads and writes one register of several servos of a bus; lost frames are sent again.

    Args:
        readout: Readout of the bus.
    """

    def __init__(self, readout: BusReadout) -> None:
        self.readout = readout
        self._all = np.arange(len(readout.ids))

    def write(self, register: Register, value: int, rows: Rows = slice(None)) -> None:
        """Write one value to the servos at `rows`, with a sync write, which is not answered."""
        self.readout.bus.sync_write(register, dict.fromkeys(self._ids(self._all[rows]), value))

    def ask(self, register: Register, rows: Rows, attempt: int = 0) -> tuple[Array, Mask]:
        """Read a register once; return (rows,) counts, and (rows,) bool: servos that answered."""
        counts: npt.NDArray[np.int64] = np.zeros(len(self._all), dtype=np.int64)
        fresh: Mask = np.zeros(len(self._all), dtype=bool)
        for part in self._parts(rows, attempt):
            counts[part], fresh[part] = self.readout.bus.sync_read(self._ids(part), register)
        return counts[self._all[rows]].astype(np.float64), fresh[self._all[rows]]

    def ask_torque(self, rows: Rows, attempt: int = 0) -> tuple[Mask, Mask]:
        """Read torque enable once; return (rows,) bool: torque on; and those that answered."""
        bus = self.readout.bus
        on: Mask = np.zeros(len(self._all), dtype=bool)
        fresh: Mask = np.zeros_like(on)
        for part in self._parts(rows, attempt):
            answers = bus.bulk_read([bus.family.torque_span(id) for id in self._ids(part)])
            for row in part:
                if (data := answers.get(self.readout.ids[row])) is not None:
                    on[row], fresh[row] = data[0] != 0, True
        return on[self._all[rows]], fresh[self._all[rows]]

    def pause(self, attempt: int) -> None:
        """Wait before an attempt, except before the first (0)."""
        if attempt:
            self.readout.bus.wait(BACKOFF * attempt)

    def _parts(self, rows: Rows, attempt: int) -> list[npt.NDArray[np.intp]]:
        """Return the groups of servos that are read together.

        In one answer, all servos after a missing one may be silent: so the second attempt reads in
        reverse order, and further ones read each servo alone.
        """
        chosen = self._all[rows]
        if attempt < 2:
            return [chosen if attempt == 0 else chosen[::-1]]
        return np.split(chosen, len(chosen))

    def read(self, register: Register, rows: Rows = slice(None)) -> Array:
        """Return the (rows,) counts of one register.

        Raises:
            HardwareError: A servo does not answer.
        """
        chosen = self._all[rows]
        counts, left = np.zeros(len(self._all)), chosen
        for attempt in range(ATTEMPTS):
            self.pause(attempt)
            counts[left], fresh = self.ask(register, left, attempt)
            left = left[~fresh]
            if not left.size:
                return counts[chosen]
        url = self.readout.bus.port.url
        raise HardwareError(
            f"{url}: no answer from {self.readout.names_at(left)}; run `windup scan {quote(url)}`"
        )

    def set(self, register: Register, values: Array, rows: Rows = slice(None)) -> None:
        """Write the (rows,) `values`, counts, and read them back.

        Raises:
            HardwareError: A servo does not answer, or reads back another value.
        """
        chosen, wanted = self._all[rows], np.rint(values)
        ids = self._ids(chosen)
        frame = dict(zip(ids, wanted.astype(int).tolist(), strict=True))
        for attempt in range(ATTEMPTS):
            self.pause(attempt)
            self.readout.bus.sync_write(register, frame)
            wrong = self.read(register, chosen) != wanted
            if not wrong.any():
                return
        stubborn = self.readout.names_at(chosen[wrong])
        raise HardwareError(
            f"{self.readout.bus.port.url}: {stubborn} did not accept {register.name}"
        )

    def _ids(self, rows: Sequence[int] | npt.NDArray[np.intp]) -> list[int]:
        return [self.readout.ids[row] for row in rows]
