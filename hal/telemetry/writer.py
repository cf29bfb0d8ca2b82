"""The writer of a telemetry ring: it belongs to the loop, and nothing in it waits.

One writer and any number of readers, which it does not know of. The ring is a plain memory-mapped
file, new for each writer and moved into place, so that a reader of an older one keeps that.
"""

import os
import time
from collections.abc import Callable
from math import nan
from pathlib import Path

import msgspec
import numpy as np

from windup.hal.backend import BusHealth, ClampReporter
from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.guard import GuardedBackend
from windup.hal.guard.imu_watch import ImuWatch
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import NOTHING, ControllerBlock, innermost, publisher_of
from windup.hal.publishing.run_state import RunState
from windup.hal.telemetry.file import make_ring
from windup.hal.telemetry.header import Header, Mark, RunNames
from windup.hal.telemetry.layout import (
    CHECK,
    CLOSED,
    CODE,
    NUMBER,
    OVER,
    REASON,
    RUNS,
    at,
    checksum,
)
from windup.hal.telemetry.record import Record
from windup.hal.telemetry.runtime_folder import ring_path
from windup.hal.telemetry.text_slots import mark_slots, name_slots
from windup.hal.telemetry.tick_health import TickHealth

SECONDS = 8.0
"""Length of the past that a ring holds, s."""
AT_SEQUENCE, AT_RUNS, AT_MARKS = at("sequence"), at("runs"), at("marks")
AT_STATE, AT_PHASE, AT_REASON = at("state"), at("phase"), at("reason")


class TelemetryWriter:
    """Writes a ring.

    Args:
        robot: Name of the robot.
        backend: Its backend, whose clamps, bus errors, alerts and warnings are written, too.
        contacts: Its contact sensors.
        rate_hz: Rate of the loop, Hz.
        port: URL of its port, or None for a twin.
        path: Path of the file; by default that of `ring_path`.
        estimated: Whether the base state is estimated from the IMU.
        imu: The check of the IMU, or None.
        versions: Maps a program to its version.

    Attributes:
        header: Header of the ring.
        path: Path of the file.
        block: Block of the present run's controller.

    Raises:
        TelemetryError: The file cannot be created.
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
        imu: ImuWatch | None = None,
        versions: dict[str, str] | None = None,
    ) -> None:
        self._guard, driver = backend, backend.backend
        self._bus = driver if isinstance(driver, BusHealth) else None
        self._driver = driver if isinstance(driver, ClampReporter) else None
        self.header = Header(
            robot=robot,
            port=port,
            rate_hz=rate_hz,
            joints=backend.joints.names,
            contacts=contacts.names,
            clamps=tuple(backend.clamps),
            driver_clamps=tuple(self._bus.clamps) if self._bus else (),
            errors=tuple(self._bus.bus_errors()) if self._bus else (),
            alerts=self._bus.alert_kinds if self._bus else (),
            pid=os.getpid(),
            started=time.time(),
            estimated=estimated,
            versions=versions or {},
        ).with_fields()
        self.path = path or ring_path(robot, port)
        self._records = max(2, round(SECONDS * rate_hz))
        self._map, head = make_ring(self.path, self.header, self._records)
        self._first, self._size = int(head["records_at"]), self.header.record_size
        self._names, self._marks = name_slots(self._map, head), mark_slots(self._map, head)
        self._record = Record(self.header)
        self._health = TickHealth(backend, self._record, imu)
        self._sequence = self._run = self._mark = 0
        self._publish: Callable[[ControllerBlock], None] | None = None
        self._clamped = self._alerted = False
        self._driver_bit = np.uint32(len(self.header.clamps))
        self.block = ControllerBlock.of(NOTHING)
        self.change_state(RunState.LIMP)

    def begin(self, controller: object = None) -> None:
        """Begin a run (again), with the controller whose block is published.

        Raises:
            TelemetryError: The names that the controller publishes are too long.
        """
        publisher = publisher_of(controller)
        names = NOTHING if publisher is None else publisher.published
        self._publish = None if publisher is None else publisher.publish
        self._record.values.fill(nan)
        self.block = ControllerBlock(self._record.values[: len(names.values)])
        run = RunNames(
            self._run + 1,
            "" if controller is None else type(innermost(controller)).__name__,
            names.phases,
            names.reasons,
            names.values,
            names.units,
        )
        self._names.write(run.run, msgspec.json.encode(run))
        self._run = run.run
        NUMBER.pack_into(self._map, AT_RUNS, run.run)
        REASON.pack_into(self._map, AT_REASON, b"")
        CODE.pack_into(self._map, AT_PHASE, RUNS)
        self.mark(f"run {run.run} begins: {run.controller or 'no controller'}")

    def record(
        self,
        observation: Observation,
        asked: JointCommand,
        applied: JointCommand,
        tick_time: float,
        lateness: float,
        tick: int,
        missed: int,
    ) -> None:
        """Write one tick.

        Args:
            observation: What was observed.
            asked: Command of the controller.
            applied: Command that the joints really got.
            tick_time: Duration of read, estimate, step and write, s.
            lateness: Time from the scheduled start of the tick until it began, s.
            tick: Number of ticks of the run so far.
            missed: Number of ticks skipped so far.
        """
        block, health, record = self.block, self._health, self._record
        if self._publish is not None:
            self._publish(block)
        health.update(observation)
        imu, base = observation.imu, observation.base
        record.put_scalars(
            self._run,
            observation.time,
            time.monotonic(),
            time.time(),
            tick_time,
            lateness,
            block.plan_lateness,
            block.phase_time,
            nan if imu is None else imu.age,
            0.0 if base is None else base.confidence,
            health.supply,
            health.hottest,
            tick,
            missed,
            block.plans,
            block.late_plans,
            block.run_state,
            block.phase,
            block.reason,
            health.hottest_joint,
            health.warnings,
            self._mark,
        )
        record.put_observation(observation)
        record.put_commands(asked, applied)
        self._note_clamps()
        self._write()

    def record_last(
        self, observation: Observation, command: JointCommand, tick: int, missed: int
    ) -> None:
        """Write the tick in which the run failed, with the command that was in effect.

        The controller is not asked for its block: it may be what has failed.
        """
        self._publish = None
        self.record(observation, command, command, 0.0, 0.0, tick, missed)

    def mark(self, text: str) -> None:
        """Write a mark: an event, with the instant at which it happened."""
        self._mark = number = self._mark + 1
        mark = Mark(number, self._sequence, time.monotonic(), text)
        while (beyond := len(msgspec.json.encode(mark)) - self._marks.room) > 0:
            cut = mark.text.encode()[: -(beyond + 1) // 2].decode(errors="ignore")
            mark = msgspec.structs.replace(mark, text=cut)
        self._marks.write(number, msgspec.json.encode(mark))
        NUMBER.pack_into(self._map, AT_MARKS, number)

    def end(self, reason: str, state: RunState = RunState.HOLDING) -> None:
        """End the run; the ring stays readable.

        Args:
            reason: Why it ended.
            state: State of the robot from now on.
        """
        self._publish = None
        text = reason.encode()[:127].decode(errors="ignore").encode()
        REASON.pack_into(self._map, AT_REASON, text)
        CODE.pack_into(self._map, AT_PHASE, OVER)
        self.mark(f"run {self._run} ends: {reason}")
        self.change_state(state)

    def change_state(self, state: RunState) -> None:
        """Publish the state of the robot between two ticks."""
        if self._map.closed:
            return
        self._state = state
        CODE.pack_into(self._map, AT_STATE, state)

    def close(self) -> None:
        """Close the ring. The file stays until a newer one takes its place."""
        self.change_state(RunState.DISCONNECTED)
        CODE.pack_into(self._map, AT_PHASE, CLOSED)
        self._map.close()

    def _note_clamps(self) -> None:
        """Put in all counters, and what clamped each joint in this tick."""
        guard, record = self._guard, self._record
        counters = [*guard.clamps.values()]
        if (bus := self._bus) is not None:
            counters += bus.clamps.values()
            counters += bus.bus_errors().values()
            self._note_alerts(bus)
        record.put_counters(counters)
        bits, driver = guard.clamp_bits, self._driver
        beyond = None if driver is None else driver.clamp_bits
        if bits is not None or beyond is not None or self._clamped:
            self._clamped = bits is not None or beyond is not None
            record.clamped[...] = guard.clamped_joints
            record.clamped_by[...] = 0 if bits is None else bits
            if beyond is not None:
                record.clamped_by |= beyond << self._driver_bit

    def _note_alerts(self, bus: BusHealth) -> None:
        """Put in what the servos signal."""
        alert = self._record.alert
        if not bus.alerts and not self._alerted:
            return
        self._alerted = bool(bus.alerts)
        alert.fill(0)
        for joint, kinds in bus.alerts.items():
            bits = sum(1 << self.header.alerts.index(kind) for kind in kinds)
            alert[self.header.joints.index(joint)] = bits

    def _write(self) -> None:
        """Copy the record into the ring, then publish its sequence number."""
        record, ring = self._record, self._map
        self._sequence = sequence = self._sequence + 1
        start = self._first + (sequence % self._records) * self._size
        CHECK.pack_into(record.data, 0, 0, checksum(sequence, record.payload))
        NUMBER.pack_into(ring, start, 0)
        ring[start : start + self._size] = record.data
        NUMBER.pack_into(ring, start, sequence)
        NUMBER.pack_into(ring, AT_SEQUENCE, sequence)
        if self.block.run_state != self._state:
            self.change_state(self.block.run_state)
