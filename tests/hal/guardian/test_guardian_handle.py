import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.hal.fake_bus1 import STS
from tests.hal.guardian.two_servos import TORQUE, emulated, patiently, record, show, switch_on
from tests.hal.mixed_robot import Wires, mount, robot
from windup.hal.errors import GuardianError, HardwareError, PortError, UsageError
from windup.hal.families import servo_model
from windup.hal.guard.levels import HealthKind, HealthLevels
from windup.hal.guardian.guarded_buses import guarded_bus
from windup.hal.guardian.handle import Guardian, guardian_for
from windup.hal.port.open_port import open_port
from windup.tools.robot.robot import Robot


@pytest.fixture
def guardian(sts_bus: Path) -> Iterator[Guardian]:
    watching = Guardian([record(sts_bus)], "limp")
    yield watching
    watching.release()


def test_a_host_that_releases_it_leaves_the_servos_alone(sts_bus: Path) -> None:
    guardian = Guardian([record(sts_bus)], "limp")
    assert guardian.alive
    switch_on(sts_bus)
    guardian.release()
    assert not guardian.alive
    assert show(sts_bus, TORQUE) == [1, 1]


def test_a_guardian_that_has_died_is_noticed_by_the_next_heartbeat(guardian: Guardian) -> None:
    os.kill(guardian.pid, signal.SIGKILL)
    guardian._process.wait()
    with pytest.raises(GuardianError, match="has died"):
        guardian.tick()


def test_a_guardian_that_was_stopped_is_noticed_and_can_be_let_go(guardian: Guardian) -> None:
    os.kill(guardian.pid, signal.SIGSTOP)
    with pytest.raises(GuardianError, match="read"):
        while True:
            guardian.tick()
            time.sleep(0.005)


def test_two_armed_runs_cannot_have_one_adapter(guardian: Guardian, sts_bus: Path) -> None:
    with pytest.raises(PortError, match="another armed run"):
        Guardian([record(sts_bus)], "limp")


def test_a_guardian_that_does_not_start_is_said(
    sts_bus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.executable", "/bin/false")
    with pytest.raises(HardwareError, match="does not start; torque stays off"):
        Guardian([record(sts_bus)], "limp")


def test_servos_that_are_emulated_in_this_process_need_none() -> None:
    wires = Wires()
    wires.add("legs", {1: STS})
    backend = robot(wires, [mount(STS, "legs", 1)])
    backend.connect()
    assert guardian_for(backend, "limp") is None
    backend.disconnect()


def test_servos_that_watch_their_bus_have_one_too(tmp_path: Path) -> None:
    path, wires, model = str(tmp_path / "bus"), Wires(), servo_model("XM430-W350")
    with emulated("twin://bench?servos=XM430-W350:1", "--pty", path):
        wires.add("arms", {1: model}, protocol=2)
        backend = robot(wires, [mount(model, "arms", 1)])
        backend._opener = lambda url, baud: open_port(path, baud)
        backend.connect()
        watching = guardian_for(
            backend, "limp", levels=HealthLevels.of([mount(model, "arms", 1)], 12.0)
        )
        assert watching is not None and watching.alive
        watching.release()
        backend.disconnect()


def test_a_guardian_lets_go_at_the_stop_levels_of_the_run() -> None:
    wires = Wires()
    wires.add("legs", {7: STS})
    backend = robot(wires, [mount(STS, "legs", 7)])
    backend.connect()
    levels = HealthLevels.of([mount(STS, "legs", 7)], 7.4, {HealthKind.TEMPERATURE: (50.0, 55.0)})
    charged = guarded_bus(backend.links[0], None, levels)
    assert charged.levels == {7: (55.0, float(levels.stop[HealthKind.SUPPLY_LOW, 0]))}
    backend.disconnect()


def test_feetech_servos_behind_a_network_are_refused() -> None:
    wires = Wires()
    wires.add("legs", {1: STS})
    backend = robot(wires, [mount(STS, "legs", 1)])
    backend.connect()
    backend.links[0].bus.port.url = "socket://bridge:4000"
    with pytest.raises(UsageError, match="have no bus watchdog"):
        guardian_for(backend, "limp")
    backend.disconnect()


def test_a_duck_on_a_terminal_has_one_while_it_is_armed(tmp_path: Path) -> None:
    path = tmp_path / "bus"
    with emulated("duck", "--pty", str(path)):
        port = f"body={path}-body,imu={path}-imu"
        with patiently(lambda: Robot.open("duck", port=port, arm=True)) as duck:
            assert duck.custody.guardian is None
            patiently(duck.arm)
            assert duck.custody.guardian is not None and duck.custody.guardian.alive
            watching = duck.custody.guardian
            duck.stop(limp=True)
            assert duck.custody.guardian is None and not watching.alive
