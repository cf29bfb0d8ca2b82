import json
import os
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from windup.hal.command import JointCommand
from windup.hal.guard import GuardedBackend, SafetyLimits
from windup.hal.observation import ImuState, JointState, Observation
from windup.hal.telemetry.reader import TelemetryReader
from windup.hal.telemetry.writer import TelemetryWriter
from windup.robots import load_robot
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.twin import Twin
from windup.tools.bringup.diagnosis import Diagnosis, Limits
from windup.tools.bringup.health import format_health
from windup.tools.cli import run
from windup.tools.robot.robot import Robot

OP3 = load_robot("op3")
LIMITS = Limits.of(OP3)
KNEE = OP3.joints.index("l_knee")
DT = 0.004


@dataclass
class OnABus(TwinBackend):
    """The twin, with a bus that errs and servos that complain."""

    alert_kinds: tuple[str, ...] = ("overheating", "overload")
    alerts: dict[str, tuple[str, ...]] = field(default_factory=dict)
    clamps: dict[str, int] = field(default_factory=lambda: {"goal": 0, "unarmed": 0})
    errors: dict[str, int] = field(default_factory=lambda: {"no answer": 0})

    def __post_init__(self) -> None:
        super().__init__(Twin(OP3))

    def bus_errors(self) -> dict[str, int]:
        return self.errors


@dataclass
class Bench:
    """A telemetry ring that is written by hand."""

    backend: OnABus
    guard: GuardedBackend
    writer: TelemetryWriter

    def observe(self, **joints: float) -> Observation:
        observation = self.backend.read()
        changed = {name: getattr(observation.joints, name).copy() for name in joints}
        for name, value in joints.items():
            changed[name][slice(None) if name == "voltage" else KNEE] = value
        return replace(observation, joints=replace(observation.joints, **changed))

    def ticks(
        self, count: int, *, first: int = 1, missed: int = 0, imu_age: float = 0.0, **joints: float
    ) -> None:
        observation = self.observe(**joints)
        assert isinstance(observation.joints, JointState)
        assert isinstance(observation.imu, ImuState)
        hold = JointCommand.hold(OP3.joints, OP3.stance)
        for k in range(first, first + count):
            lost = missed if k > first else 0
            seen = replace(
                observation, time=(k + lost) * DT, imu=replace(observation.imu, age=imu_age)
            )
            self.writer.record(seen, hold, hold, 1e-4, 0.0, k, lost)

    def diagnose(self, later: float = 0.0) -> Diagnosis:
        with TelemetryReader(self.writer.path) as reader:
            newest = reader.latest()
            assert newest is not None
            return Diagnosis.of(reader, LIMITS, float(newest["wall"]) + later)

    def problems(self) -> list[str]:
        return [f"{each.subject}: {each.problem}" for each in self.diagnose().problems]


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    return tmp_path


@pytest.fixture
def bench(folder: Path) -> Iterator[Bench]:
    backend = OnABus()
    guard = GuardedBackend(backend, SafetyLimits.of(OP3.joints))
    writer = TelemetryWriter("op3", guard, OP3.contacts, 1.0 / DT)
    yield Bench(backend, guard, writer)
    writer.close()


def test_a_robot_that_is_well_has_no_problems(bench: Bench) -> None:
    bench.ticks(100)
    found = bench.diagnose()
    assert found.healthy
    result = found.result()
    assert (result["state"], result["ticks"], result["missed"]) == ("running", 100, 0)
    assert result["rate_hz"] == pytest.approx(250.0)
    assert [row["name"] for row in result["joints"]] == list(OP3.joints.names)


def test_problems_name_the_joint_and_the_limit(bench: Bench) -> None:
    bench.ticks(500, temperature=71.0, voltage=10.1, age=0.2)
    assert bench.problems() == [
        "l_knee: silent for 0.20 s (limit 0.125 s)",
        "20 joints: on 10.1 V (stop below 10.2)",
        "l_knee: at 71 degrees C (warning at 65)",
    ]
    warnings = bench.diagnose().result()["warnings"]
    assert [(row["kind"], row["value"], row["limit"]) for row in warnings] == [
        ("supply low", 10.1, 10.2),
        ("temperature", 71.0, 65.0),
    ]


def test_too_much_voltage_is_the_wrong_supply(bench: Bench) -> None:
    bench.ticks(500, voltage=16.8)
    (problem,) = bench.diagnose().problems
    assert problem.remedy == "switch the power off: it is the wrong supply"


def test_a_dip_is_no_problem(bench: Bench) -> None:
    bench.ticks(200)
    bench.ticks(50, first=201, voltage=9.0, temperature=90.0)
    bench.ticks(250, first=251)
    assert bench.problems() == []


def test_a_blocked_joint_is_told(bench: Bench) -> None:
    stall = OP3.joints.torque[KNEE]
    bench.ticks(500, torque=0.7 * stall, position=float(OP3.stance[KNEE]) - 0.3, velocity=0.0)
    assert bench.problems() == [
        "l_knee: at 61 % of stall torque for a second (warning at 60 %)",
        "l_knee: blocked at full torque for 0.8 s (stop at 0.8 s)",
    ]


def test_the_imu_is_judged_where_the_base_is_estimated_from_it(folder: Path) -> None:
    backend = OnABus()
    guard = GuardedBackend(backend, SafetyLimits.of(OP3.joints))
    for estimated in (False, True):
        writer = TelemetryWriter("op3", guard, OP3.contacts, 1.0 / DT, estimated=estimated)
        bench = Bench(backend, guard, writer)
        bench.ticks(400)  # the same sample again and again
        frozen = ["the IMU: repeating one sample for 1.6 s (warning at 1.0 s)"]
        assert bench.problems() == (frozen if estimated else [])
        writer.close()


def test_late_plans_are_told_with_what_to_do(bench: Bench) -> None:
    bench.ticks(100)
    bench.writer.block.plans, bench.writer.block.late_plans = 40, 7
    bench.ticks(1, first=101)
    (problem,) = bench.diagnose().problems
    assert str(problem) == (
        "loop: 7 of 40 plans came late; "
        "this computer is too slow for 250 Hz: try `--model library` or a lower --rate"
    )


def test_what_is_not_measured_is_no_problem(bench: Bench) -> None:
    bench.ticks(10, voltage=np.nan, temperature=np.nan, imu_age=np.nan)
    assert bench.problems() == []


def test_missed_ticks_count_above_one_in_a_hundred(bench: Bench) -> None:
    bench.ticks(99, missed=1)
    assert bench.problems() == []
    bench.writer.begin()
    bench.ticks(97, missed=3)
    assert bench.problems() == ["loop: 3 % of the ticks came late"]


def test_bus_errors_alerts_and_clamps_are_told(bench: Bench) -> None:
    bench.ticks(50)
    bench.backend.errors["no answer"] = 9
    bench.backend.alerts["l_knee"] = ("overload",)
    pose = OP3.stance.copy()
    pose[KNEE] = 3.0
    for _ in range(20):
        bench.guard.write(JointCommand.hold(OP3.joints, pose))
    bench.ticks(50, first=51)
    assert bench.problems() == [
        "bus: 'no answer' 9 times in 100 ticks",
        "l_knee: its servo reports: overload",
        "l_knee: clamped in 20% of the ticks",
    ]
    assert bench.diagnose().result()["clamps"] == {"position": 20}


def test_what_the_driver_clamps_is_told_apart_from_what_the_guard_does(bench: Bench) -> None:
    bench.ticks(50)
    bench.backend.clamps["goal"] = 7
    bench.ticks(50, first=51)
    found = bench.diagnose()
    assert found.result()["driver_clamps"] == {"goal": 7}
    assert found.result()["clamps"] == {}
    console = Console(width=200)
    with console.capture() as said:
        console.print(format_health(found))
    assert "driver clamps: goal 7" in said.get()


def test_only_the_last_run_counts(bench: Bench) -> None:
    bench.ticks(50, temperature=90.0, age=0.2)
    bench.writer.begin()
    bench.ticks(20)
    found = bench.diagnose()
    assert found.healthy
    assert len(found.ticks) == 20


def test_a_silent_loop_stands_still_or_is_dead_or_has_ended(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench.ticks(10)
    still = bench.diagnose(later=3.0)
    assert still.state == "standing still"
    assert still.problems[0].problem == "no tick for 3.0 s"

    def gone(pid: int, signal: int) -> None:
        raise ProcessLookupError

    monkeypatch.setattr(os, "kill", gone)
    assert bench.diagnose().state == "dead"
    assert not bench.diagnose().healthy
    bench.writer.end("done")
    assert bench.diagnose(later=3.0).state == "ended"
    assert bench.diagnose(later=3.0).healthy


# The command


def test_nothing_to_read_is_status_2_with_the_command_to_start(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(["health", "op3"]) == 2
    assert "start a run with `windup walk op3" in " ".join(capsys.readouterr().err.split())


def test_a_ring_without_ticks_is_nothing_to_read(bench: Bench) -> None:
    assert run(["health", "op3"]) == 2


def test_the_health_of_a_run_is_told_to_people_and_programs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with Robot.open("op3") as robot:
        robot.stand(0.2)
    target = tmp_path / "health.json"
    assert run(["health", "op3", "--once", "--json", str(target)]) == 0
    result = json.loads(target.read_text())
    assert (result["command"], result["healthy"], result["state"]) == ("health", True, "ended")
    assert (result["ticks"], result["reason"]) == (50, "done")
    text = capsys.readouterr().err
    assert "l_knee" in text
    assert "healthy" in text


def test_an_unhealthy_robot_is_status_1(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.ticks(500, temperature=80.0)
    assert run(["health", "op3"]) == 1
    assert "l_knee: at 80 degrees C (stop at 72); let it cool" in capsys.readouterr().err


def test_once_and_watch_exclude_each_other(bench: Bench) -> None:
    bench.ticks(1)
    assert run(["health", "op3", "--once", "--watch"]) == 2
