import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.errors import TelemetryError
from windup.hal.guard import GuardedBackend, SafetyLimits
from windup.hal.joints import Joint, Joints
from windup.hal.observation import BaseState, ImuState, JointState, Observation
from windup.hal.telemetry.layout import FIXED, ring_path
from windup.hal.telemetry.ring import TelemetryReader, TelemetryWriter
from windup.hal.torque_state import TorqueState

JOINTS = Joints(tuple(Joint(name, -1.0, 1.0, 10.0, 1.0) for name in ("hip", "knee")))
CONTACTS = ContactSensors(("heel", "toe"), {"foot": ("heel", "toe")})
NAN3, NAN4 = np.full(3, np.nan), np.full(4, np.nan)


class Standing:
    """A clock that stands still."""

    def now(self) -> float:
        return 0.0

    def wait_until(self, time: float) -> None:
        pass


@dataclass
class Servos:
    """Two servos on a bus that fails now and then."""

    joints: Joints = JOINTS
    clock: Standing = field(default_factory=Standing)
    alert_kinds: tuple[str, ...] = ("heat", "load")
    alerts: dict[str, tuple[str, ...]] = field(default_factory=dict)
    clamps: dict[str, int] = field(default_factory=lambda: {"goal": 0, "unarmed": 0})
    errors: dict[str, int] = field(default_factory=lambda: {"no answer": 0, "corrupt": 0})

    def bus_errors(self) -> Mapping[str, int]:
        return self.errors

    def connect(self) -> None: ...
    def configure(self) -> None: ...
    def request(self) -> None: ...
    def disconnect(self) -> None: ...

    def collect(self) -> Observation:
        return observation()

    def read(self) -> Observation:
        return observation()

    def write(self, command: JointCommand) -> JointCommand:
        return command

    def set_torque(self, on: bool) -> TorqueState:
        return TorqueState.known(np.full(2, on))


def observation(time: float = 0.0, whole: bool = True) -> Observation:
    rows = [np.array([k + 0.25, k + 0.5]) for k in range(6)]
    base = BaseState(np.arange(3.0), np.array([1.0, 0, 0, 0]), np.ones(3), np.zeros(3), 0.5)
    imu = ImuState(None, np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 9.81]), 0.004)
    joints = JointState(*rows)
    contacts = np.array([0.0, 7.0])
    return Observation(time, joints, imu if whole else None, contacts, base if whole else None)


def write(writer: TelemetryWriter, ticks: range) -> None:
    for k in ticks:
        command = JointCommand.hold(JOINTS, np.array([0.1, 0.01 * k]))
        writer.record(observation(0.1 * k), command, 1e-3, k, 0)


@pytest.fixture
def guard() -> GuardedBackend:
    return GuardedBackend(Servos(), SafetyLimits.of(JOINTS))


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
    assert tick["command"].tolist() == [0.1, 0.02]
    assert tick["contacts"].tolist() == [0.0, 7.0]
    assert tick["imu_acceleration"].tolist() == [0.0, 0.0, 9.81]
    assert tick["base_position"].tolist() == [0.0, 1.0, 2.0]
    assert tick["errors"].tolist() == [0, 3]
    assert tick["alert"].tolist() == [0, 0b10]
    assert tick["clamps"].tolist() == [1, 0, 0, 0, 0]
    assert tick["clamped"].tolist() == [0, 1]
    assert reader.header.driver_clamps == ("goal", "unarmed")
    assert tick["driver_clamps"].tolist() == [0, 2]


def test_what_is_not_measured_is_not_a_number(writer: TelemetryWriter) -> None:
    hold = JointCommand.hold(JOINTS, np.zeros(2))
    writer.record(observation(whole=False), hold, 1e-3, 1, 0)
    with TelemetryReader(writer.path) as reader:
        tick = reader.latest()
    assert tick is not None
    for name in ("imu_orientation", "imu_angular_velocity", "base_position", "imu_age"):
        assert np.isnan(tick[name]).all(), name
    assert tick["base_confidence"] == 0.0


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


@pytest.mark.parametrize("place", [0, 9, 16, -1], ids=["sequence", "checksum", "first", "last"])
def test_a_torn_tick_is_left_out(writer: TelemetryWriter, place: int) -> None:
    write(writer, range(1, 4))
    with TelemetryReader(writer.path) as reader:
        size = reader.header.dtype().itemsize
        data = bytearray(writer.path.read_bytes())
        first = len(data) - 8 * size
        data[first + 2 * size + place % size] ^= 1
        writer.path.write_bytes(bytes(data))
    with TelemetryReader(writer.path) as reader:
        assert reader.since()["tick"].tolist() == [1, 3]


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
from windup.hal.telemetry.ring import TelemetryReader
reader = TelemetryReader(Path(sys.argv[1]))
print(reader.since()["tick"].tolist())
"""


def test_another_process_reads_and_goes_and_the_ring_stays(writer: TelemetryWriter) -> None:
    write(writer, range(1, 3))
    command = [sys.executable, "-c", READ, str(writer.path)]
    for _ in range(2):
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        assert (done.stdout, done.stderr) == ("[1.0, 2.0]\n", "")
    write(writer, range(3, 4))
    with TelemetryReader(writer.path) as reader:
        assert len(reader.since()) == 3


def test_a_file_that_is_no_ring_is_refused(writer: TelemetryWriter, tmp_path: Path) -> None:
    for content in (b"", b"short", bytes(1000), b"WINDUPTR" + bytes(1000)):
        path = tmp_path / "other.ring"
        path.write_bytes(content)
        with pytest.raises(TelemetryError, match=r"other\.ring"):
            TelemetryReader(path)
    path.write_bytes(writer.path.read_bytes()[: FIXED.size + 600])
    with pytest.raises(TelemetryError, match="its size"):
        TelemetryReader(path)
    with pytest.raises(TelemetryError, match="there is no telemetry"):
        TelemetryReader(tmp_path / "missing.ring")


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
