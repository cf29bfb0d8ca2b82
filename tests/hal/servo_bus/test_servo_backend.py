from math import nan, pi

import numpy as np
import pytest

from tests.hal.backend_robot import COUNT, XM430, Robot, joints_of
from tests.hal.fake_bus import VirtualClock, fake_port
from windup.hal.command import JointCommand
from windup.hal.families import servo_model
from windup.hal.imu.opencr import OpenCr
from windup.hal.servo_bus.servo_backend import BusPort, ServoBackend
from windup.hal.servos.servo_model import ServoMount


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
    torque = np.array([1.8876, 0.0, 0.0, 0.0])
    command = JointCommand.of(robot.backend.joints, position=0.0, torque=torque)
    robot.backend.write(command)
    assert robot.serial.get(1, 116, 4) == round(2048 + 0.1 / COUNT)


def test_a_goal_past_the_encoder_is_clamped_and_counted() -> None:
    robot = Robot().up()
    real = robot.backend.write(JointCommand.hold(robot.backend.joints, np.full(4, 4.0)))
    assert robot.serial.get(1, 116, 4) == 4095
    assert robot.backend.clamps["goal"] == 1
    assert robot.backend.clamp_bits is not None
    assert (robot.backend.clamp_bits == 0b1).all()
    robot.backend.write(JointCommand.hold(robot.backend.joints, np.zeros(4)))
    assert robot.backend.clamp_bits is None
    assert real.position[0] == pytest.approx(2047 * COUNT)


def test_gains_are_sent_only_when_they_change() -> None:
    robot = Robot().up()
    hold = JointCommand.hold(robot.backend.joints, np.zeros(4))
    robot.backend.write(hold)
    before = len(robot.serial.requests)
    robot.backend.write(hold)
    assert len(robot.serial.requests) == before + 1
    softer = JointCommand.of(robot.backend.joints, position=0.0, stiffness=hold.stiffness / 2)
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
    one_bus = backend.readouts[0].bus.exchange
    assert state.position.tolist() == pytest.approx([0.0, 100 * COUNT, 0.0, 0.0])
    assert clock.now() - start < 1.5 * (16 + 8 + 2 * 14 + 2) * 10 / one_bus.port.baud


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
