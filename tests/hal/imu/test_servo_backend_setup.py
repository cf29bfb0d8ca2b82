import pytest

from tests.hal.backend_robot import XM430, Robot, joints_of, written_registers
from tests.hal.fake_bus import fake_port
from windup.hal.errors import ConfigError, HardwareError, UsageError
from windup.hal.imu.opencr import OpenCr
from windup.hal.servo_bus.servo_backend import BusPort, ServoBackend
from windup.hal.servos.servo_model import ServoMount


def test_configure_writes_only_what_differs() -> None:
    robot = Robot()
    robot.backend.configure()
    assert written_registers(robot.serial) == {(id, 9) for id in range(1, 5)}
    robot.serial.written.clear()
    robot.backend.configure()
    assert robot.serial.written == []
    assert all(robot.serial.get(id, 64, 1) == 0 for id in range(1, 5))


def test_configure_names_everything_that_is_wrong_and_writes_nothing() -> None:
    robot = Robot()
    robot.serial.put(1, 0, 1060, 2)
    robot.serial.silent.add(3)
    robot.serial.put(4, 64, 1, 1)
    with pytest.raises(HardwareError) as caught:
        robot.backend.configure()
    assert str(caught.value) == (
        "fake://bus: 3 things not as in robot.toml: "
        "joint 'j0' id 1: is a XL430-W250 where a XM430-W350 should be; "
        "joint 'j2' id 3: no answer; "
        "joint 'j3' id 4: cannot correct return_delay 250 instead of 0 while torque is on; "
        "switch it off with `windup stop` first; "
        "run `windup scan fake://bus`"
    )
    assert robot.serial.written == []


def test_two_servos_with_one_id_are_recognised_by_their_broken_answers() -> None:
    robot = Robot()
    robot.serial.spoil = lambda id, frame: frame[:-1] + b"\x00" if id == 2 else frame
    with pytest.raises(HardwareError, match=r"joint 'j1' id 2: only corrupt answers \(two servos"):
        robot.backend.configure()
    assert robot.serial.written == []


def test_an_id_twice_is_refused() -> None:
    mounts = [ServoMount(XM430, "body", 5, 1, 2048, 1.0)] * 2
    with pytest.raises(ConfigError, match="joints 'j0' and 'j1' both have id 5 on bus 'body'"):
        ServoBackend(joints_of(2), mounts, {"body": BusPort("fake://bus", 1_000_000)})


def test_a_range_past_the_encoder_is_refused() -> None:
    mount = ServoMount(XM430, "body", 5, 1, 3800, 1.0)
    with pytest.raises(ConfigError, match=r"joint 'j0' \(id 5 on bus 'body'\): its range is 2822 "):
        ServoBackend(joints_of(1), [mount], {"body": BusPort("fake://bus", 1_000_000)})


def test_a_bus_without_a_port_is_refused() -> None:
    mount = ServoMount(XM430, "legs", 5, 1, 2048, 1.0)
    with pytest.raises(UsageError, match="unknown bus 'legs'; known: body"):
        ServoBackend(joints_of(1), [mount], {"body": BusPort("fake://bus", 1_000_000)})


def test_torque_comes_on_at_the_present_pose_with_the_watchdog_armed() -> None:
    robot = Robot().up()
    for id in range(1, 5):
        robot.serial.put(id, 132, 1000 + id, 4)
    robot.serial.written.clear()
    assert robot.backend.set_torque(True).all_on
    order = [start for _, start, _ in robot.serial.written]
    assert order.index(116) < order.index(64)
    assert [robot.serial.get(id, 116, 4) for id in range(1, 5)] == [1001, 1002, 1003, 1004]
    assert [robot.serial.get(id, 98, 1) for id in range(1, 5)] == [10] * 4
    assert robot.backend.set_torque(False).all_off
    assert [robot.serial.get(id, 98, 1) for id in range(1, 5)] == [0] * 4


def test_no_torque_comes_on_where_a_servo_cannot_be_read() -> None:
    robot = Robot().up()
    robot.serial.silent.add(2)
    with pytest.raises(HardwareError, match=r"no answer from j1 \(id 2\); .* off at j1$"):
        robot.backend.set_torque(True)
    assert all(robot.serial.get(id, 64, 1) == 0 for id in range(1, 5))


def test_a_silent_servo_counts_as_powered() -> None:
    robot = Robot().up()
    robot.backend.set_torque(True)
    robot.serial.silent.add(2)
    assert robot.backend.set_torque(False).unknown.tolist() == [False, True, False, False]


def test_a_watchdog_that_fired_is_cleared_at_the_present_pose() -> None:
    robot = Robot().up()
    robot.backend.set_torque(True)
    robot.backend.read()
    robot.backend.clock.wait_until(robot.backend.clock.now() + 1.0)
    robot.serial.put(2, 98, -1, 1)
    robot.serial.put(2, 132, 1234, 4)
    robot.backend.read()
    assert robot.backend.watchdog_trips == 1
    assert robot.serial.get(2, 98, 1) == 10 and robot.serial.get(2, 116, 4) == 1234
    robot.backend.read()
    assert robot.backend.watchdog_trips == 1


def test_an_opencr_gives_the_servos_power() -> None:
    robot = Robot(board=OpenCr("body"))
    robot.serial.put(200, 24, 0, 1)
    robot.backend.configure()
    assert robot.serial.get(200, 24, 1) == 1


def test_buses_of_two_worlds_are_refused() -> None:
    wires = {name: fake_port([1]) for name in ("left", "right")}
    mounts = [ServoMount(XM430, name, 1, 1, 2048, 1.0) for name in ("left", "right")]
    ports = {name: BusPort(name, 1_000_000) for name in wires}
    backend = ServoBackend(joints_of(2), mounts, ports, opener=lambda url, baud: wires[url][1])
    with pytest.raises(UsageError, match="must share one clock"):
        backend.connect()
    assert not any(serial.is_open for serial, _ in wires.values())
