import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.hal.telemetry.small_ring import (
    CONTACTS,
    JOINTS,
    Servos,
    guarded,
    observation,
    write,
)
from windup.hal.command import JointCommand
from windup.hal.errors import TelemetryError
from windup.hal.guard import GuardedBackend
from windup.hal.telemetry.header import bits_of
from windup.hal.telemetry.layout import HEAD, VERSION, at
from windup.hal.telemetry.reader import TelemetryReader
from windup.hal.telemetry.runtime_folder import ring_path
from windup.hal.telemetry.writer import TelemetryWriter


@pytest.fixture
def guard() -> GuardedBackend:
    return guarded()


@pytest.fixture
def writer(guard: GuardedBackend, tmp_path: Path) -> TelemetryWriter:
    return TelemetryWriter("duo", guard, CONTACTS, 1.0, path=tmp_path / "duo.ring")


def test_what_is_written_is_read(writer: TelemetryWriter, guard: GuardedBackend) -> None:
    servos = guard.backend
    assert isinstance(servos, Servos)
    servos.errors["corrupt"] = 3
    servos.clamps["unarmed"] = 2
    servos.alerts["knee"] = ("load",)
    guard.write(JointCommand.hold(JOINTS, np.array([0.0, 5.0])))
    write(writer, range(1, 3))
    with TelemetryReader(writer.path) as reader:
        assert reader.header == writer.header
        assert (reader.header.robot, reader.header.joints) == ("duo", ("hip", "knee"))
        tick = reader.latest()
    assert tick is not None
    assert (tick["sequence"], tick["tick"], tick["time"]) == (2, 2, 0.2)
    names = ("position", "velocity", "torque", "voltage", "temperature", "age")
    for k, name in enumerate(names):
        assert tick[name].tolist() == [k + 0.25, k + 0.5], name
    assert tick["asked"][0].tolist() == [0.1, 0.02]
    assert tick["asked"][3:].tolist() == [[10.0, 10.0], [1.0, 1.0]]
    assert tick["applied"][0].tolist() == [2.0, 2.0]
    assert (tick["tick_time"], tick["lateness"]) == (1e-3, 2e-3)
    assert tick["contacts"].tolist() == [0.0, 7.0]
    assert tick["imu_acceleration"].tolist() == [0.0, 0.0, 9.81]
    assert tick["base_position"].tolist() == [0.0, 1.0, 2.0]
    assert tick["errors"].tolist() == [0, 3]
    assert tick["alert"].tolist() == [0, 0b10]
    assert tick["clamps"].tolist() == [1, 0, 0, 0, 0]
    assert tick["clamped"].tolist() == [0, 1]
    assert bits_of(tick["clamped_by"][1], reader.header.clamp_bits) == ["guard position"]
    assert (tick["supply"], tick["hottest"], tick["hottest_joint"]) == (3.25, 4.5, 1)
    assert reader.header.driver_clamps == ("goal", "unarmed")
    assert tick["driver_clamps"].tolist() == [0, 2]


def test_what_is_not_measured_is_not_a_number(writer: TelemetryWriter) -> None:
    hold = JointCommand.hold(JOINTS, np.zeros(2))
    writer.record(observation(whole=False), hold, hold, 1e-3, 0.0, 1, 0)
    with TelemetryReader(writer.path) as reader:
        tick = reader.latest()
    assert tick is not None
    for name in ("imu_orientation", "imu_angular_velocity", "base_position", "imu_age"):
        assert np.isnan(tick[name]).all(), name
    assert tick["base_confidence"] == 0.0


def test_what_the_driver_clamps_has_its_own_bits_until_it_does_not(
    writer: TelemetryWriter, guard: GuardedBackend
) -> None:
    servos = guard.backend
    assert isinstance(servos, Servos)
    servos.clamp_bits = np.array([0b10, 0], dtype=np.uint32)
    guard.write(JointCommand.hold(JOINTS, np.array([5.0, 0.0])))
    write(writer, range(1, 2))
    servos.clamp_bits = None
    guard.write(JointCommand.hold(JOINTS, np.zeros(2)))
    write(writer, range(2, 3))
    with TelemetryReader(writer.path) as reader:
        first, second = reader.since()["clamped_by"]
    assert bits_of(first[0], writer.header.clamp_bits) == ["guard position", "driver unarmed"]
    assert not first[1] and not second.any()


def test_an_alert_that_is_over_is_taken_back(
    writer: TelemetryWriter, guard: GuardedBackend
) -> None:
    servos = guard.backend
    assert isinstance(servos, Servos)
    servos.alerts["hip"] = ("heat", "load")
    write(writer, range(1, 2))
    servos.alerts.clear()
    write(writer, range(2, 3))
    with TelemetryReader(writer.path) as reader:
        assert reader.since()["alert"].tolist() == [[3, 0], [0, 0]]


def test_a_ring_keeps_its_last_seconds(writer: TelemetryWriter) -> None:
    write(writer, range(1, 21))
    with TelemetryReader(writer.path) as reader:
        assert reader.since()["tick"].tolist() == list(range(13, 21))  # 8 s at 1 Hz
        assert reader.since(18)["tick"].tolist() == [19, 20]
        assert len(reader.since(20)) == 0
        assert reader.sequence == 20


def test_an_empty_ring_has_no_ticks(writer: TelemetryWriter) -> None:
    with TelemetryReader(writer.path) as reader:
        assert reader.latest() is None
        assert len(reader.since()) == 0


def test_a_run_says_why_it_ended_until_the_next_begins(writer: TelemetryWriter) -> None:
    with TelemetryReader(writer.path) as reader:
        assert reader.ended is None
        writer.end("fell " + 200 * "ü")
        assert reader.ended is not None
        assert reader.ended.startswith("fell üü")
        writer.begin()
        assert reader.ended is None


def test_a_reader_keeps_the_old_ring_and_sees_that_there_is_a_new_one(
    writer: TelemetryWriter, guard: GuardedBackend
) -> None:
    write(writer, range(1, 4))
    with TelemetryReader(writer.path) as reader:
        assert not reader.replaced
        again = TelemetryWriter("duo", guard, CONTACTS, 1.0, path=writer.path)
        write(again, range(7, 8))
        assert reader.replaced
        assert reader.since()["tick"].tolist() == [1, 2, 3]
    with TelemetryReader(writer.path) as reader:
        assert reader.since()["tick"].tolist() == [7]
    assert list(writer.path.parent.iterdir()) == [writer.path]


READ = """
import sys
from pathlib import Path
from windup.hal.telemetry.reader import TelemetryReader
reader = TelemetryReader(Path(sys.argv[1]))
print(reader.since()["tick"].tolist())
"""


def test_another_process_reads_and_goes_and_the_ring_stays(writer: TelemetryWriter) -> None:
    write(writer, range(1, 3))
    command = [sys.executable, "-c", READ, str(writer.path)]
    for _ in range(2):
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        assert (done.stdout, done.stderr) == ("[1, 2]\n", "")
    write(writer, range(3, 4))
    with TelemetryReader(writer.path) as reader:
        assert len(reader.since()) == 3


def test_a_file_that_is_no_ring_is_refused(writer: TelemetryWriter, tmp_path: Path) -> None:
    path, whole = tmp_path / "other.ring", writer.path.read_bytes()
    for content in (b"short", bytes(1000), whole[: HEAD.itemsize - 1], whole[:-1]):
        path.write_bytes(content)
        with pytest.raises(TelemetryError, match=r"other\.ring: it is (cut|not telemetry)"):
            TelemetryReader(path)
    path.write_bytes(b"")
    with pytest.raises(TelemetryError, match="cannot be read"):
        TelemetryReader(path)
    with pytest.raises(TelemetryError, match="there is no telemetry"):
        TelemetryReader(tmp_path / "missing.ring")


@pytest.mark.parametrize("version", [2, VERSION + 1])
def test_another_version_is_named_in_one_line(writer: TelemetryWriter, version: int) -> None:
    content = bytearray(writer.path.read_bytes())
    content[at("version")] = version
    writer.path.write_bytes(bytes(content))
    with pytest.raises(TelemetryError) as error:
        TelemetryReader(writer.path)
    assert str(error.value) == (
        f"{writer.path}: it is telemetry of version {version}, and this program reads version "
        f"{VERSION}; use the windup that wrote it"
    )


def test_rings_are_private_and_one_a_robot_and_port(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    ports = (None, "/dev/ttyUSB0", "dev_ttyUSB0", "socket://pi.local:5000")
    paths = {ring_path("op3", port) for port in ports} | {ring_path("human")}
    assert len(paths) == 5
    assert {path.parent for path in paths} == {tmp_path / "windup"}
    assert (tmp_path / "windup").stat().st_mode & 0o777 == 0o700


def test_somebody_elses_folder_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "windup").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(TelemetryError, match="not your folder"):
        ring_path("op3")
