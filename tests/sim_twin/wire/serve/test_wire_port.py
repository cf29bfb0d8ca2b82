import numpy as np
import pytest
import serial

from tests.sim_twin.wire.wire_host import open_host
from windup.hal.errors import UnknownNameError, UsageError
from windup.sim_twin.wire import find_world, parse_address, register_world, unregister_world
from windup.sim_twin.wire.boards.opencr import ACCELERATION_UNIT, GYRO_UNIT, OpenCr
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.imu.imu import RestingImu
from windup.sim_twin.wire.protocols.dynamixel2 import Dynamixel2
from windup.sim_twin.wire.protocols.frames import encode
from windup.sim_twin.wire.schedule import Schedule
from windup.sim_twin.wire.world.bus_world import BenchPhysics, BusWorld


@pytest.mark.parametrize(
    ("url", "message"),
    [
        ("twin://", "'twin://' is not a twin:// address; 'twin://op3' is"),
        ("twin://op3?clok=real", "unknown option 'clok'; did you mean 'clock'?"),
        ("twin://op3?clock=fast", "clock is one of virtual, real, not 'fast'"),
        ("twin://op3?supply=high", "supply is a number, not 'high'"),
        ("twin://bench?servos=XM430", "'XM430': a model and its ids"),
        ("twin://bench?servos=XM43:1", "unknown servo model 'XM43'"),
        ("twin://bench?faults=dorp:1", "unknown kind 'dorp'; did you mean 'drop'?"),
        ("twin://bench?faults=drop:2", "rate 2: give 0 .. 1"),
        ("twin://bench?bus=legs", "unknown bus 'legs'"),
        ("twin://opp3", "unknown robot 'opp3'; did you mean 'op3'?"),
        ("twin://human", "has no servos on a bus"),
    ],
)
def test_a_wrong_address_says_what_is_wrong(url: str, message: str) -> None:
    with pytest.raises(serial.SerialException) as caught:
        serial.serial_for_url(url)
    assert message in str(caught.value)
    assert isinstance(caught.value.__cause__, UsageError)


def test_two_opens_of_one_world_share_it_and_its_time() -> None:
    url = "twin://bench?world=shared"
    with open_host(url) as one, open_host(url) as two:
        assert one.world is two.world
        two.write(1, "led", 1)
        assert one.read(1, "led") == 1
        assert one.now == two.now
    with open_host("twin://bench?world=shared") as again:
        assert again.read(1, "led") == 1
        assert find_world("shared") is again.world
    unregister_world("shared")
    with pytest.raises(UnknownNameError):
        find_world("shared")


def test_a_world_without_a_name_ends_with_its_last_port() -> None:
    with open_host() as host:
        host.write(1, "led", 1)
    with open_host() as host:
        assert host.read(1, "led") == 0


def test_one_world_has_one_clock() -> None:
    with open_host("twin://bench?world=clocked"), pytest.raises(serial.SerialException):
        serial.serial_for_url("twin://bench?world=clocked&clock=real")
    unregister_world("clocked")


def test_writes_only_schedule_and_reads_let_time_pass() -> None:
    with open_host(timeout=0.5) as host:
        began = host.now
        host.port.write(encode(1, 1))
        assert host.now == began
        assert host.port.in_waiting == 0
        host.port.timeout = 0
        assert host.port.read(14) == b""
        assert host.now == began
        host.port.timeout = 0.5
        assert len(host.port.read(14)) == 14
        passed = host.now
        assert passed < began + 0.01
        assert host.port.read(1) == b""
        assert host.now == pytest.approx(passed + 0.5)


def test_a_read_that_can_never_end_is_an_error() -> None:
    with open_host() as host:
        host.port.timeout = None
        with pytest.raises(serial.SerialException, match="without an answer"):
            host.port.read(1)


def test_two_buses_do_not_wait_for_each_other() -> None:
    with open_host("twin://bench?servos=XM430-W350:1-20&return_delay=0&world=a") as one:
        bus = one.port.bus
        other = Bus("other", list(bus.devices), Dynamixel2(), one.world.schedule)
        one.world.buses["other"] = other
        with open_host("twin://bench?world=a&bus=other") as two:
            request = encode(254, 0x82, bytes((126, 0, 10, 0, *range(1, 21))))
            began = one.now
            one.port.write(request)
            two.port.write(request)
            assert len(one.port.read(420)) == 420
            assert len(two.port.read(420)) == 420
            assert one.now - began == pytest.approx((len(request) + 420) * 1e-5)
    unregister_world("a")


def test_a_closed_port_says_so() -> None:
    with open_host() as host:
        pass
    with pytest.raises(serial.PortNotOpenError):
        host.port.read(1)


def test_a_real_clock_keeps_time_with_the_wall() -> None:
    with open_host("twin://bench?clock=real", timeout=0.05) as host:
        assert host.read(1, "present_position") == 2048
        before = host.now
        host.wait(0.02)
        assert host.now - before >= 0.02


def test_the_address_is_parsed_into_si() -> None:
    address = parse_address("twin://op3?clock=real&world=w&bus=legs&supply=11.1&latency=2")
    assert (address.robot, address.clock, address.world, address.bus) == (
        "op3",
        "real",
        "w",
        "legs",
    )
    assert (address.supply, address.latency) == (11.1, 2.0)


class Turning(RestingImu):
    angular_velocity = np.array([1.0, 2.0, 3.0])
    acceleration = np.array([0.5, -0.5, 9.5])
    orientation = np.array([np.cos(0.1), np.sin(0.1), 0.0, 0.0])


def test_the_opencr_reports_its_imu_and_switches_the_servo_power() -> None:
    with open_host("twin://bench?servos=XM430-W350:1") as host:
        servo, schedule = host.servo(1), Schedule()
        board = OpenCr(Turning(), [servo], supply=11.3)
        bus = Bus("body", [servo, board], Dynamixel2(), schedule)
        register_world("opencr", BusWorld(BenchPhysics([host.shaft(1)]), schedule, {"body": bus}))
    with open_host("twin://anything?world=opencr") as host:
        board.buttons = 2
        assert host.ask(1, 1) == []  # no power
        assert host.ask(200, 1)[0].parameters[1:3] == b"\x00\x74"
        data = host.ask(200, 2, bytes((30, 0, 20, 0)))[0].parameters[1:]
        assert data[:2] == bytes((2, 113))
        values = np.frombuffer(data[2:], "<i2")
        assert values[0:3] * GYRO_UNIT == pytest.approx([-1.0, -2.0, 3.0], abs=2e-3)
        assert values[3:6] * ACCELERATION_UNIT == pytest.approx([-0.5, 0.5, 9.5], abs=1e-3)
        assert values[6:9].tolist() == [115, 0, 0]  # 0.2 rad
        assert host.ask(200, 3, bytes((24, 0, 1)))[0].parameters == b"\0"
        assert host.ask(1, 1) == []  # it boots
        host.wait(0.4)
        assert len(host.ask(1, 1)) == 1
    unregister_world("opencr")
