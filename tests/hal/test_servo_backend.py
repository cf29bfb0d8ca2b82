from math import nan, pi

import numpy as np
import pytest

from hal.command import JointCommand
from hal.errors import ConfigError, HardwareError, UsageError
from hal.imu.opencr import OpenCr
from hal.joints import Joint, Joints
from hal.servo_backend import BusPort, ServoBackend
from hal.servo_model import ServoMount
from hal.servos import servo_model
from tests.hal.fake_bus import FakeSerial, VirtualClock, fake_port

XM430 = servo_model("XM430-W350")
COUNT = 2.0 * pi / 4096


def joints_of(n: int, reach: float = 1.5) -> Joints:
    return Joints(tuple(Joint(f"j{i}", -reach, reach, 18.876, 0.85) for i in range(n)))


class Robot:
    """n joints on one bus, odd ones mounted backwards, and the fake wire behind them."""

    def __init__(self, n: int = 4, board: OpenCr | None = None, watchdog: float = 0.2) -> None:
        extra = [board.id] if board else []
        self.serial, port = fake_port([*range(1, n + 1), *extra])
        self.mounts = [
            ServoMount(XM430, "body", i + 1, -1 if i % 2 else 1, 2048, 1.0) for i in range(n)
        ]
        self.backend = ServoBackend(
            joints_of(n),
            self.mounts,
            {"body": BusPort("fake://bus", 1_000_000)},
            board=board,
            watchdog=watchdog,
            opener=lambda url, baud: port,
        )
        if board:
            self.serial.memory[board.id] = bytearray(256)
            self.serial.put(board.id, 24, 1, 1)
        self.backend.connect()

    def up(self) -> "Robot":
        self.backend.configure()
        return self


def written_registers(serial: FakeSerial) -> set[tuple[int, int]]:
    return {(id, start) for id, start, _ in serial.written}


def test_counts_become_joint_angles_with_sign_and_zero() -> None:
    robot = Robot()
    for id in (1, 2):
        robot.serial.put(id, 132, 2048 + 100, 4)
        robot.serial.put(id, 128, 10, 4)
        robot.serial.put(id, 126, -100, 2)
    robot.up()
    state = robot.backend.read().joints
    assert state.position[:2] == pytest.approx([100 * COUNT, -100 * COUNT])
    speed = 10 * 0.229 * 2 * pi / 60
    assert state.velocity[:2] == pytest.approx([speed, -speed])
    constant = XM430.torque_constant or nan
    assert state.torque[:2] == pytest.approx([-0.269 * constant, 0.269 * constant])
    assert state.voltage.tolist() == [12.0] * 4 and state.temperature.tolist() == [35.0] * 4
    assert state.age.tolist() == [0.0] * 4


def test_a_load_is_no_torque() -> None:
    serial, port = fake_port([1])
    serial.put(1, 0, 1060, 2)
    mount = ServoMount(servo_model("XL430-W250"), "body", 1, 1, 2048, 1.0)
    ports = {"body": BusPort("fake://bus", 1_000_000)}
    backend = ServoBackend(joints_of(1), [mount], ports, opener=lambda url, baud: port)
    backend.connect()
    backend.configure()
    assert np.isnan(backend.read().joints.torque[0])


def test_a_linkage_ratio_divides_angles_and_squares_gains() -> None:
    serial, port = fake_port([1])
    mount = ServoMount(XM430, "body", 1, 1, 2048, 2.0)
    ports = {"body": BusPort("fake://bus", 1_000_000)}
    backend = ServoBackend(joints_of(1, 0.7), [mount], ports, opener=lambda url, baud: port)
    backend.connect()
    serial.put(1, 132, 2048 + 400, 4)
    backend.configure()
    assert backend.read().joints.position[0] == pytest.approx(200 * COUNT)
    real = backend.write(JointCommand.hold(backend.joints, np.array([0.1])))
    assert serial.get(1, 84, 2) == 200  # a quarter of 800
    assert serial.get(1, 116, 4) == round(2048 + 0.2 / COUNT)
    assert real.stiffness[0] == pytest.approx(18.876, rel=1e-3)


def test_write_returns_what_the_servos_make_of_it() -> None:
    robot = Robot().up()
    command = JointCommand.hold(robot.backend.joints, np.full(4, 0.3))
    real = robot.backend.write(command)
    assert real.position == pytest.approx(command.position, abs=COUNT / 2)
    assert real.stiffness == pytest.approx(XM430.stiffness(800, 12.0))
    assert real.damping == pytest.approx(XM430.damping(12.0))
    assert not real.velocity.any() and not real.torque.any()


def test_feed_forward_shifts_the_goal() -> None:
    robot = Robot().up()
    command = JointCommand.hold(robot.backend.joints, np.zeros(4))
    command.torque[0] = 1.8876
    robot.backend.write(command)
    assert robot.serial.get(1, 116, 4) == round(2048 + 0.1 / COUNT)


def test_a_goal_past_the_encoder_is_clamped_and_counted() -> None:
    robot = Robot().up()
    real = robot.backend.write(JointCommand.hold(robot.backend.joints, np.full(4, 4.0)))
    assert robot.serial.get(1, 116, 4) == 4095
    assert robot.backend.clamps["goal"] == 1
    assert real.position[0] == pytest.approx(2047 * COUNT)


def test_gains_are_sent_only_when_they_change() -> None:
    robot = Robot().up()
    hold = JointCommand.hold(robot.backend.joints, np.zeros(4))
    robot.backend.write(hold)
    before = len(robot.serial.requests)
    robot.backend.write(hold)
    assert len(robot.serial.requests) == before + 1
    softer = JointCommand(hold.block.copy())
    softer.stiffness[:] /= 2
    robot.backend.write(softer)
    assert len(robot.serial.requests) == before + 3
    assert robot.serial.get(1, 84, 2) == 400


def test_a_good_frame_that_jumps_is_another_servos() -> None:
    robot = Robot().up()
    robot.backend.read()
    robot.serial.put(2, 132, 3000, 4)
    robot.backend.clock.wait_until(robot.backend.clock.now() + 0.008)
    state = robot.backend.read().joints
    assert state.position[1] == 0.0 and state.age[1] > 0.0
    assert robot.backend.bus_errors()["implausible"] == 1


def test_a_silent_joint_keeps_its_state_and_grows_old() -> None:
    robot = Robot().up()
    robot.backend.read()
    robot.serial.silent.add(3)
    robot.serial.put(3, 132, 2100, 4)
    for _ in range(30):
        robot.backend.clock.wait_until(robot.backend.clock.now() + 0.004)
        state = robot.backend.read().joints
    assert state.position[2] == 0.0 and state.age[2] > 0.1
    assert state.age[[0, 1, 3]].tolist() == [0.0] * 3
    robot.serial.silent.clear()
    assert robot.backend.read().joints.age.tolist() == [0.0] * 4


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
        "fake://bus: 3 things not as wired: "
        "joint 'j0' id 1: is a XL430-W250 where a XM430-W350 should be; "
        "joint 'j2' id 3: no answer; "
        "joint 'j3' id 4: torque is on and return_delay 250 instead of 0; `windup stop` first; "
        "run `windup scan fake://bus`"
    )
    assert robot.serial.written == []


def test_two_servos_with_one_id_are_recognised_by_their_broken_answers() -> None:
    robot = Robot()
    robot.serial.spoil = lambda id, frame: frame[:-1] + b"\x00" if id == 2 else frame
    with pytest.raises(HardwareError, match=r"joint 'j1' id 2: only broken answers \(two servos"):
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


def test_a_hardware_error_is_told_by_joint_name_while_it_lasts() -> None:
    robot = Robot().up()
    robot.serial.error[2] = 0x80
    robot.serial.put(2, 70, 0b100100, 1)
    robot.backend.read()
    assert robot.backend.alerts == {"j1": ("overheating", "overload")}
    robot.serial.error[2] = 0
    robot.backend.read()
    assert robot.backend.alerts == {}


def test_voltage_and_temperature_are_refreshed_one_servo_at_a_time() -> None:
    robot = Robot().up()
    for id in range(1, 5):
        robot.serial.put(id, 144, 100 + id, 2)
        robot.serial.put(id, 146, 40 + id, 1)
    for _ in range(45):
        state = robot.backend.read().joints
    assert state.voltage == pytest.approx([10.1, 10.2, 10.3, 10.4])
    assert state.temperature.tolist() == [41.0, 42.0, 43.0, 44.0]
    assert state.position.tolist() == [0.0] * 4


def test_the_imu_comes_in_the_same_transaction_with_its_axes_turned() -> None:
    robot = Robot(board=OpenCr("body")).up()
    robot.serial.put(200, 32, 1640, 2)
    robot.serial.put(200, 42, 16384, 2)
    before = len(robot.serial.requests)
    imu = robot.backend.read().imu
    assert len(robot.serial.requests) == before + 1
    assert imu is not None and imu.orientation is None
    assert imu.angular_velocity == pytest.approx([-100 * pi / 180, 0, 0], rel=1e-3)
    assert imu.acceleration == pytest.approx([0, 0, 9.80665])
    robot.serial.silent.add(200)
    robot.backend.clock.wait_until(robot.backend.clock.now() + 0.01)
    later = robot.backend.read()
    assert later.imu is not None and later.imu.age > 0.01
    assert later.joints.age.tolist() == [0.0] * 4


def test_an_opencr_gives_the_servos_power() -> None:
    robot = Robot(board=OpenCr("body"))
    robot.serial.put(200, 24, 0, 1)
    robot.backend.configure()
    assert robot.serial.get(200, 24, 1) == 1


def test_two_buses_are_read_side_by_side() -> None:
    clock = VirtualClock()
    wires = {name: fake_port([1, 2], clock) for name in ("left", "right")}
    mounts = [
        ServoMount(XM430, name, id, 1, 2048, 1.0) for id in (1, 2) for name in ("left", "right")
    ]
    ports = {name: BusPort(name, 1_000_000) for name in wires}
    backend = ServoBackend(joints_of(4), mounts, ports, opener=lambda url, baud: wires[url][1])
    backend.connect()
    wires["right"][0].put(1, 132, 2148, 4)
    backend.configure()
    start = clock.now()
    state = backend.read().joints
    one_bus = backend.lines[0].bus.exchange
    assert state.position.tolist() == pytest.approx([0.0, 100 * COUNT, 0.0, 0.0])
    assert clock.now() - start < 1.5 * (16 + 8 + 2 * 14 + 2) * 10 / one_bus.port.baud


def test_buses_of_two_worlds_are_refused() -> None:
    wires = {name: fake_port([1]) for name in ("left", "right")}
    mounts = [ServoMount(XM430, name, 1, 1, 2048, 1.0) for name in ("left", "right")]
    ports = {name: BusPort(name, 1_000_000) for name in wires}
    backend = ServoBackend(joints_of(2), mounts, ports, opener=lambda url, baud: wires[url][1])
    with pytest.raises(UsageError, match="one world, on one clock"):
        backend.connect()
    assert not any(serial.is_open for serial, _ in wires.values())


def test_a_broken_fast_chain_is_read_plainly_until_all_are_back() -> None:
    robot = Robot().up()
    robot.serial.silent.add(1)
    robot.backend.read()
    for _ in range(30):
        state = robot.backend.read().joints
        assert state.age[1:].tolist() == [0.0] * 3
    robot.serial.silent.clear()
    for _ in range(3):
        robot.backend.read()
    assert 0x8A in {request[7] for request in robot.serial.requests[-3:]}
