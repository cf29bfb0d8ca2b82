"""The ring in shared memory that everybody else reads: viewer, logger, health.

One writer, the loop, and any number of readers, none of which it knows of. The ring is a plain
memory-mapped file, new for each writer and moved into place, so that a reader of an older one
keeps what it has. A tick that is overwritten while it is read shows in its sequence number or its
checksum; readers then take the next one.
"""

import mmap
import os
import time as wall
from pathlib import Path
from typing import Self

import msgspec
import numpy as np
import numpy.typing as npt

from windup.hal.backend import BusHealth
from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.errors import TelemetryError
from windup.hal.guard import GuardedBackend
from windup.hal.observation import Observation
from windup.hal.telemetry.file import make_ring, read_header
from windup.hal.telemetry.layout import (
    CLOSED,
    ENDED,
    ENDED_AT,
    HEAD,
    HEAD_AT,
    OVER,
    PAYLOAD_AT,
    RUNS,
    STATE,
    Header,
    checksum,
    ring_path,
)

SECONDS = 8.0
"""How much of the past a ring holds, s."""
Ticks = npt.NDArray[np.void]


class TelemetryWriter:
    """Writes a ring. It is the loop's: nothing here waits, and 15 us a tick are enough.

    Args:
        robot: The robot's name.
        backend: Its backend, whose clamps, bus errors and alerts are written along.
        contacts: Its contact sensors.
        rate_hz: Rate of the loop, Hz.
        port: The URL of its port, or None for a twin.
        path: The file, by default where `ring_path` says.
        estimated: The base state comes from the IMU.

    Attributes:
        plans: Steps planned in this run, and plans that came late.

    Raises:
        TelemetryError: The file cannot be made.
    """

    def __init__(
        self,
        robot: str,
        backend: GuardedBackend,
        contacts: ContactSensors,
        rate_hz: float,
        *,
        port: str | None = None,
        path: Path | None = None,
        estimated: bool = False,
    ) -> None:
        self._backend = backend
        self._bus = backend.backend if isinstance(backend.backend, BusHealth) else None
        self.header = Header(
            robot=robot,
            port=port,
            rate_hz=rate_hz,
            joints=backend.joints.names,
            contacts=contacts.names,
            errors=tuple(self._bus.bus_errors()) if self._bus else (),
            alerts=self._bus.alert_kinds if self._bus else (),
            pid=os.getpid(),
            started=wall.time(),
            clamps=tuple(backend.clamps),
            estimated=estimated,
            driver_clamps=tuple(self._bus.clamps) if self._bus else (),
        )
        self.path = path or ring_path(robot, port)
        self._prepare()
        self._map, self._first = make_ring(self.path, self.header, self._slots, len(self._bytes))
        self._sequence = 0
        self.plans = (0, 0)

    def _prepare(self) -> None:
        """Make the one record that every tick is written through, and views of its parts."""
        header = self.header
        record = np.zeros(1, dtype=header.dtype())
        self._bytes = memoryview(record.view(np.uint8))  # type: ignore[arg-type]
        self._payload = self._bytes[PAYLOAD_AT:]
        self._head = record.view(np.uint64)[:2]
        self._numbers = record.view(np.float64)[2:]
        self._few = np.zeros(
            9 + len(header.clamps) + len(header.driver_clamps) + len(header.errors)
        )
        self._alert = np.zeros(len(header.joints))
        self._no_age = np.zeros(len(header.joints))
        self._none = {size: np.full(size, np.nan) for size in (3, 4)}
        self._slots = max(2, round(SECONDS * header.rate_hz))

    def begin(self) -> None:
        """A run begins (again)."""
        self.plans = (0, 0)
        ENDED.pack_into(self._map, ENDED_AT, RUNS, b"")

    def record(
        self,
        observation: Observation,
        command: JointCommand,
        seconds: float,
        tick: int,
        missed: int,
    ) -> None:
        """Write one tick: what was seen, what the joints were told, and how long it took."""
        joints, imu, base = observation.joints, observation.imu, observation.base
        no3, no4 = self._none[3], self._none[4]
        self._few[:] = [*self._scalars(observation, seconds, tick, missed), *self._counters()]
        np.concatenate(
            (
                self._few,
                joints.position,
                joints.velocity,
                joints.torque,
                joints.voltage,
                joints.temperature,
                joints.age,
                self._no_age if joints.health_age is None else joints.health_age,
                command.block[0],
                command.block[3],
                self._backend.clamped_joints,
                self._alert,
                observation.contacts,
                no4 if imu is None or imu.orientation is None else imu.orientation,
                imu.angular_velocity if imu else no3,
                imu.acceleration if imu else no3,
                base.position if base else no3,
                base.orientation if base else no4,
                base.linear_velocity if base else no3,
                base.angular_velocity if base else no3,
            ),
            out=self._numbers,
        )
        self._publish()

    def _scalars(
        self, observation: Observation, seconds: float, tick: int, missed: int
    ) -> tuple[float, ...]:
        """Return times, tick numbers, plans, age of the IMU and confidence."""
        imu, base = observation.imu, observation.base
        age, confidence = imu.age if imu else np.nan, base.confidence if base else 0.0
        return observation.time, wall.time(), tick, missed, seconds, *self.plans, age, confidence

    def _counters(self) -> list[int]:
        """Return all counters of clamps and bus errors, and note the alerts."""
        counters = [*self._backend.clamps.values()]
        if (bus := self._bus) is not None:
            counters += bus.clamps.values()
            counters += bus.bus_errors().values()
            self._note_alerts(bus)
        return counters

    def end(self, reason: str) -> None:
        """The run is over; the ring stays for whoever wants to know how it went."""
        text = reason.encode()[:127].decode(errors="ignore").encode()
        ENDED.pack_into(self._map, ENDED_AT, OVER, text)

    def close(self) -> None:
        """Give the mapping back. The file stays, until newer ones have taken its place."""
        STATE.pack_into(self._map, ENDED_AT, CLOSED)
        self._map.close()

    def _publish(self) -> None:
        """Put the record into its slot, then say that it is there."""
        self._sequence = sequence = self._sequence + 1
        self._head[0] = sequence
        self._head[1] = checksum(sequence, self._payload)
        start = self._first + (sequence % self._slots) * len(self._bytes)
        self._map[start : start + len(self._bytes)] = self._bytes
        HEAD.pack_into(self._map, HEAD_AT, sequence)

    def _note_alerts(self, bus: BusHealth) -> None:
        if not bus.alerts and not self._alert.any():
            return
        self._alert[:] = 0.0
        for joint, kinds in bus.alerts.items():
            bits = sum(1 << self.header.alerts.index(kind) for kind in kinds)
            self._alert[self.header.joints.index(joint)] = bits


class TelemetryReader:
    """Reads a ring, while it is written or after.

    Args:
        path: The file; `ring_path` knows where.

    Attributes:
        header: What stays the same from tick to tick.

    Raises:
        TelemetryError: There is no such file, or it is no ring of this version.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            with path.open("rb") as file:
                self._inode = os.fstat(file.fileno()).st_ino
                self._map = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        except FileNotFoundError:
            raise TelemetryError(f"{path}: there is no telemetry") from None
        except (OSError, ValueError) as error:
            raise TelemetryError(f"{path}: cannot be read: {error}") from None
        try:
            self.header, self._first, self._slots = read_header(self._map)
        except (ValueError, msgspec.DecodeError) as error:
            self._map.close()
            raise TelemetryError(f"{path}: is no telemetry of this version: {error}") from None
        self._dtype = self.header.dtype()

    @property
    def sequence(self) -> int:
        """Number of the newest tick; 0 before any."""
        return int(HEAD.unpack_from(self._map, HEAD_AT)[0])

    @property
    def ended(self) -> str | None:
        """Why the run ended, or None while it lasts."""
        over, reason = ENDED.unpack_from(self._map, ENDED_AT)
        return reason.rstrip(b"\0").decode(errors="replace") if over else None

    @property
    def closed(self) -> bool:
        """True when its writer has gone in good order."""
        return int(STATE.unpack_from(self._map, ENDED_AT)[0]) == CLOSED

    @property
    def replaced(self) -> bool:
        """True when a new writer has begun another ring: open that one."""
        try:
            return self.path.stat().st_ino != self._inode
        except OSError:
            return True

    def latest(self) -> np.void | None:
        """Return the newest tick, or None before any; its fields are those of the header."""
        ticks = self.since(self.sequence - 1)
        return ticks[-1] if len(ticks) else None

    def since(self, sequence: int = 0) -> Ticks:
        """Return the ticks (m,) after tick `sequence` that the ring still holds, oldest first."""
        newest = self.sequence
        oldest = max(sequence + 1, newest - self._slots + 1, 1)
        found = [data for s in range(oldest, newest + 1) if (data := self._slot(s)) is not None]
        return np.frombuffer(b"".join(found), dtype=self._dtype)

    def close(self) -> None:
        """Give the mapping back."""
        self._map.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def _slot(self, sequence: int) -> bytes | None:
        """Return the bytes of a tick, or None when they are being overwritten."""
        size = self._dtype.itemsize
        start = self._first + (sequence % self._slots) * size
        data = self._map[start : start + size]
        head = np.frombuffer(data, dtype=np.uint64, count=2)
        whole = int(head[0]) == sequence and int(head[1]) == checksum(sequence, data[PAYLOAD_AT:])
        return data if whole else None
