import os
from pathlib import Path

import numpy as np
import pytest
from serial.tools import list_ports

from tests.hal.fake_bus1 import STS
from tests.hal.mixed_robot import Wires, mount, robot, ticks
from windup.hal.command import JointCommand
from windup.hal.errors import HardwareError
from windup.hal.families import servo_model
from windup.hal.port.open_port import open_port, stable_url
from windup.hal.port.port_reopener import PortReopener
from windup.hal.servo_bus.servo_backend import ServoBackend

XM = servo_model("XM430-W350")


def armed() -> tuple[Wires, ServoBackend]:
    wires = Wires()
    wires.add("legs", {1: STS, 2: STS})
    wires.add("arms", {1: XM}, protocol=2)
    mounts = [mount(STS, "legs", 1), mount(STS, "legs", 2), mount(XM, "arms", 1)]
    backend = robot(wires, mounts)
    backend.connect()
    backend.configure()
    backend.set_torque(True)
    return wires, backend


def hold(backend: ServoBackend) -> None:
    backend.write(JointCommand.hold(backend.joints, np.full(3, 0.2)))


@pytest.mark.parametrize("name", ["legs", "arms"])
def test_an_unplugged_bus_coasts_and_the_others_go_on(name: str) -> None:
    wires, backend = armed()
    wires.unplugged.add(name)
    for _ in range(20):
        ticks(backend, 1)
        hold(backend)
    age = backend.read().joints.age
    gone = [0, 1] if name == "legs" else [2]
    assert (age[gone] > 0.1).all() and np.delete(age, gone).max() < 0.01
    assert list(backend.lost) == [name]
    assert wires.open == 1


def test_when_it_is_back_torque_is_off_and_goals_wait_for_rearm() -> None:
    wires, backend = armed()
    wires.unplugged.add("legs")
    ticks(backend, 3)
    wires.unplugged.clear()
    ticks(backend, 60)
    assert backend.lost == {} and backend.read().joints.age.max() < 0.01
    assert [wires["legs"].show(id, "torque_enable") for id in (1, 2)] == [0, 0]
    before = wires["legs"].show(1, "goal_position")
    hold(backend)
    assert wires["legs"].show(1, "goal_position") == before
    with pytest.raises(HardwareError, match="legs was disconnected after arming"):
        backend.set_torque(True)
    wires["legs"].set(1, "position_d_gain", 32)  # the servo had no power meanwhile
    assert backend.rearm().all_on
    assert wires["legs"].show(1, "position_d_gain") == 0
    hold(backend)
    assert wires["legs"].show(1, "goal_position") != before


def test_torque_that_cannot_be_read_back_is_switched_off_until_it_can() -> None:
    wires, backend = armed()
    wires.unplugged.add("legs")
    ticks(backend, 3)
    wires.unplugged.clear()
    wires["legs"].silent.update((1, 2))
    ticks(backend, 60)
    assert wires["legs"].show(1, "torque_enable") == 1
    wires["legs"].silent.clear()
    ticks(backend, 60)
    assert [wires["legs"].show(id, "torque_enable") for id in (1, 2)] == [0, 0]


def test_arming_again_without_the_port_is_refused_with_what_was_seen() -> None:
    wires, backend = armed()
    wires.unplugged.add("arms")
    ticks(backend, 3)
    with pytest.raises(HardwareError, match="cannot arm again: port arms was disconnected"):
        backend.rearm()
    assert backend.set_torque(False).unknown.tolist() == [False, False, True]


def test_a_hundred_times_at_any_moment_leave_one_open_port_each() -> None:
    wires, backend = armed()
    rng = np.random.default_rng(4)
    for _ in range(100):
        name = str(rng.choice(["legs", "arms"]))
        ticks(backend, int(rng.integers(1, 4)))
        if rng.random() < 0.5:
            backend.request()
        wires.unplugged.add(name)
        backend.collect()
        hold(backend)
        ticks(backend, int(rng.integers(1, 40)))
        wires.unplugged.clear()
        ticks(backend, 40)
        assert backend.lost == {} and wires.open == 2
        assert backend.rearm().all_on
    backend.disconnect()
    assert wires.open == 0


class Adapter:
    def __init__(self, device: str, serial_number: str | None) -> None:
        self.device, self.serial_number = device, serial_number


def test_a_device_is_found_again_by_a_serial_number_of_its_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ports = [Adapter("/dev/ttyA", "77"), Adapter("/dev/ttyB", None), Adapter("/dev/ttyC", "5")]
    ports.append(Adapter("/dev/ttyD", "5"))
    monkeypatch.setattr(list_ports, "comports", lambda: ports)
    urls = ["/dev/ttyA", "/dev/ttyB", "/dev/ttyC", "twin://op3", "usb:9"]
    assert [stable_url(url) for url in urls] == [
        "usb:77",
        "/dev/ttyB",
        "/dev/ttyC",
        "twin://op3",
        "usb:9",
    ]


def test_a_device_is_found_again_from_another_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, slave = os.openpty()
    (tmp_path / "bus").symlink_to(os.ttyname(slave))
    monkeypatch.chdir(tmp_path)
    replug = PortReopener("bus", 1_000_000, open_port)
    monkeypatch.chdir("/")
    replug.lose(0.0)
    assert replug.try_reopen(1.0) is not None
    replug.close()
