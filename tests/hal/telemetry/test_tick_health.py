from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.hal import servo_state
from tests.hal.telemetry.small_ring import Servos
from windup.hal.contacts import ContactSensors
from windup.hal.guard import GuardedBackend, SafetyLimits
from windup.hal.guard.imu_watch import IMU_KINDS, ImuWatch
from windup.hal.observation import Observation
from windup.hal.telemetry.header import bits_of
from windup.hal.telemetry.reader import TelemetryReader
from windup.hal.telemetry.writer import TelemetryWriter

HOT, COOL = {"temperature": 68.0}, {"temperature": 40.0}


def record(writer: TelemetryWriter, guard: GuardedBackend, seen: list[Observation]) -> None:
    assert guard.watch is not None
    for k, observation in enumerate(seen):
        guard.watch.update(observation)
        command = servo_state.goal(0.0)
        writer.record(observation, command, command, 0.0, 0.0, k + 1, 0)


@pytest.fixture
def guard() -> GuardedBackend:
    limits = SafetyLimits.of(servo_state.JOINTS)
    return GuardedBackend(Servos(joints=servo_state.JOINTS), limits, watch=servo_state.watch())


def test_a_warning_is_published_while_it_lasts(guard: GuardedBackend, tmp_path: Path) -> None:
    path = tmp_path / "leg.ring"
    writer = TelemetryWriter("leg", guard, ContactSensors((), {}), 1 / servo_state.DT, path=path)
    hot = servo_state.stretch(3.0, **HOT)
    record(writer, guard, [*hot, *servo_state.stretch(1.0, begin=3.0, **COOL)])
    with TelemetryReader(path) as reader:
        ticks, kinds = reader.since(), reader.header.warning_kinds
    at = ticks["time"]
    warm = (at > 1.1) & (at < 3.0)
    assert (ticks["warnings"] > 0)[warm].all()
    assert not ticks["warnings"][(at < 0.9) | (at > 3.1)].any()
    tick = ticks[warm][0]
    assert bits_of(tick["warnings"], kinds) == ["temperature"]
    assert [bits_of(bits, kinds) for bits in tick["joint_warnings"]] == [[], ["temperature"], []]
    assert (tick["supply"], tick["hottest"], tick["hottest_joint"]) == (12.0, 68.0, 1)


def test_a_fault_of_the_imu_has_a_bit(guard: GuardedBackend, tmp_path: Path) -> None:
    path, imu = tmp_path / "leg.ring", ImuWatch()
    contacts = ContactSensors((), {})
    writer = TelemetryWriter("leg", guard, contacts, 1 / servo_state.DT, path=path, imu=imu)
    for observation in servo_state.stretch(1.0):  # without any sample
        imu.update(observation)
        record(writer, guard, [observation])
    with TelemetryReader(path) as reader:
        tick = reader.latest()
        assert tick is not None
        assert bits_of(tick["warnings"], reader.header.warning_kinds) == ["imu silent"]


def test_every_fault_of_the_imu_has_its_own_bit() -> None:
    assert len(set(IMU_KINDS)) == len(IMU_KINDS) == 4


def test_what_is_not_measured_has_no_hottest_joint(guard: GuardedBackend, tmp_path: Path) -> None:
    path = tmp_path / "leg.ring"
    writer = TelemetryWriter("leg", guard, ContactSensors((), {}), 100.0, path=path)
    observation = servo_state.seen(0.0, voltage=np.nan)
    unknown = replace(observation.joints, temperature=np.full(3, np.nan))
    record(writer, guard, [replace(observation, joints=unknown)])
    with TelemetryReader(path) as reader:
        tick = reader.latest()
    assert tick is not None
    assert np.isnan(tick["supply"]) and np.isnan(tick["hottest"])
    assert tick["hottest_joint"] == -1
