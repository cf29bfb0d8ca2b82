"""Readout of the servos of one bus: decodes their answers into the arrays of all joints."""

from collections import deque
from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from windup.hal.bus.bus import Bus
from windup.hal.imu.opencr import OpenCr
from windup.hal.joints import Array, Mask
from windup.hal.protocols.cyclic import CyclicWrite
from windup.hal.servo_bus.bus_reads import BusReads, CycleRead, ExtraViews
from windup.hal.servo_bus.plausibility import Plausibility
from windup.hal.servo_bus.units import gain_groups
from windup.hal.servos.servo_model import ServoMount

LOWEST_OF = 2.0
"""Time window of `lowest_supply`, s."""
ATTEMPTS = 5
"""Maximum number of reads of voltage and temperature until all servos have answered."""

Rows = slice | npt.NDArray[np.intp]


class BusReadout:
    """The servos of one bus within a robot of n joints.

    Attributes:
        bus: The bus.
        ids: Ids of the servos.
        rows: Indices of their joints in the robot.
        row_index: The same as an index, a slice if possible.
        mounts: Mounts of the servos.
        names: Names of their joints; () if unknown.
        reads: Selects the read of each cycle.
        check: Plausibility check of the readings; None if readings are not collected.
        imu: The last bytes read from the OpenCR, or None before any.
        imu_fresh: Whether they came with the last answers.
        answered: (servos,) bool: servos that answered the last cycle, plausibly or not.
        all_well: Whether all servos answered plausibly, and none signals an error or lacks torque.
        without_torque: (servos,) bool: servos whose registers showed no torque, or a restart;
            cleared by `TorqueCheck`.
        goals: Sync write of goal positions, counts.
        gains: Gain register, rows of its servos, and the sync write, for each gain register.
    """

    def __init__(
        self,
        bus: Bus,
        mounts: Sequence[ServoMount],
        rows: Sequence[int],
        board: OpenCr | None = None,
        check: Plausibility | None = None,
        names: Sequence[str] = (),
    ) -> None:
        self.bus, self.mounts, self.check = bus, tuple(mounts), check
        self.ids = tuple(mount.id for mount in mounts)
        self.rows: npt.NDArray[np.intp] = np.array(rows, dtype=np.intp)
        # Usually there is one bus in joint order; a slice is faster than an index array.
        whole = self.rows.tolist() == list(range(len(self.ids)))
        self.row_index: Rows = slice(len(self.ids)) if whole else self.rows
        self.names, self.board = tuple(names), board
        self.imu: bytes | None = None
        self.imu_fresh = self.all_well = False
        self.answered: Mask = np.zeros(len(self.ids), dtype=bool)
        self.without_torque: Mask = np.zeros(len(self.ids), dtype=bool)
        self._volt = bus.family.registers["present_voltage"].unit
        self._volts: deque[tuple[float, float]] = deque(maxlen=100)
        family = bus.family
        self.goals = self.goals_of(self.ids)
        self.gains = [
            (gain, at, family.protocol.write([self.ids[row] for row in at], gain.register))
            for gain, at in gain_groups(mounts)
        ]
        self.reads = BusReads(bus, self.ids, [mount.model for mount in mounts], board)
        self._asked = self.reads.next()

    def names_at(self, rows: Iterable[int]) -> str:
        """Return the names of the servos at `rows`, such as "l_knee (id 13)" or "id 13"."""
        if not self.names:
            return ", ".join(f"id {self.ids[row]}" for row in rows)
        return ", ".join(f"{self.names[row]} (id {self.ids[row]})" for row in rows)

    def goals_of(self, ids: Sequence[int]) -> CyclicWrite:
        """Return a sync write of goal positions, counts, to some of the servos."""
        family = self.bus.family
        return family.protocol.write(ids, family.registers["goal_position"])

    def request(self) -> None:
        """Request the state of all servos of the bus, and of the board."""
        self._asked = self.reads.next()
        self.bus.exchange.request(self._asked.read, rest=True)

    def collect(self, counts: Array, health: Array, error: npt.NDArray[np.uint8]) -> Mask:
        """Collect the answers; return (servos,) bool: valid and plausible ones, in order of `rows`.

        Args:
            counts: (3, n) position, velocity and current of all joints; updated by new readings.
            health: (3, n) voltage V, temperature degrees C, and their time, s; updated likewise.
            error: (n,) error bytes; updated likewise.
        """
        asked, servos = self._asked, len(self.ids)
        answered = self.bus.exchange.collect()
        self.all_well = False
        if not answered.size:
            self.imu_fresh = False
            self.answered = np.zeros(servos, dtype=bool)
            return self.answered
        self.answered = valid = answered[:servos]
        self.imu_fresh = self.board is not None and bool(answered[-1])
        if self.imu_fresh:
            self.imu = asked.read.params(servos)
        self.reads.broken_chain = not asked.read.complete
        believed = self._put(asked, valid, counts, error)
        if asked.extra is not None and (fresh := believed[asked.extra.rows]).any():
            self._take_health(asked.extra, fresh, health)
            self._look_at_torque(asked.extra, fresh)
        return believed

    def errors(self, error: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
        """Return the (servos,) error bytes of this bus from those of all joints (n,)."""
        return error[self.row_index]

    def lowest_supply(self) -> float:
        """Return the lowest supply read in the last `LOWEST_OF` s, V; NaN without a reading."""
        since = self.bus.port.clock.now() - LOWEST_OF
        return min((volts for time, volts in self._volts if time >= since), default=np.nan)

    def read_health(self, health: Array) -> None:
        """Read voltage and temperature of all servos into `health` (3, n), outside the cycle."""
        asked = self.reads.health()
        for _ in range(ATTEMPTS):
            self.bus.exchange.request(asked.read)
            fresh = self.bus.exchange.collect()[: len(self.ids)]
            if asked.extra is not None and fresh.any():
                self._take_health(asked.extra, fresh, health)
            if fresh.all():
                break

    def reset(self) -> None:
        """Reset the plausibility check and the fast read: servos may have moved, or be missing."""
        self.reads.broken_chain = True
        self.all_well = self.imu_fresh = False
        if self.check is not None:
            self.check.reset()

    def _put(
        self, asked: CycleRead, valid: Mask, counts: Array, error: npt.NDArray[np.uint8]
    ) -> Mask:
        read, block = asked.read, asked.block
        records = self._records(asked)
        position, velocity, effort = block.counts(records)
        errors = read.error[: len(self.ids)]
        complete = read.complete
        if self.check is not None:
            valid = self.check.accept(position, velocity, valid, self.bus.port.clock.now())
            complete = bool(valid.all())
            self.bus.exchange.errors["implausible"] = self.check.rejected
        rows: Rows = self.row_index
        if not complete:
            rows = self.rows[valid]
            position, velocity, effort = position[valid], velocity[valid], effort[valid]
            errors = errors[valid]
        self.all_well = complete and not errors.any()
        counts[0, rows] = position
        counts[1, rows] = velocity
        counts[2, rows] = effort
        error[rows] = errors
        return valid

    def _records(self, asked: CycleRead) -> npt.NDArray[np.void]:
        """Return the (servos,) records of the block in the last answers."""
        payload, block = asked.read.payload, asked.block
        if asked.state_at is not None:
            payload = payload.take(asked.state_at)
        return payload[: len(self.ids) * block.size].view(block.dtype)

    def _take_health(self, extra: ExtraViews, fresh: Mask, health: Array) -> None:
        """Store voltage and temperature of the servos that are `fresh`."""
        rows = self.rows[extra.rows][fresh]
        volts = extra.volts[fresh] * self._volt
        health[0, rows] = volts
        health[1, rows] = extra.degrees[fresh]
        health[2, rows] = now = self.bus.port.clock.now()
        self._volts.append((now, float(volts.min())))

    def _look_at_torque(self, extra: ExtraViews, fresh: Mask) -> None:
        """Mark servos as slack whose torque registers show no torque, or a restart."""
        for counts, restarted in extra.torque:
            gone = fresh & ((counts == 0) | (counts == restarted))
            if gone.any():
                self.without_torque[extra.rows] |= gone
                self.all_well = False
