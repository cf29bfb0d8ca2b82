"""PortHandlers of the makers' SDKs on the virtual clock of an emulated bus."""

import time
from collections.abc import Iterator

import dynamixel_sdk
import pytest
import scservo_sdk

from windup.hal.errors import UsageError
from windup.tools.testing.servo_bus import ServoBus

POSITION = 132
TIMEOUT = 0.034  # s, at least; what dynamixel_sdk waits for an answer with its 16 ms of latency


@pytest.fixture
def bus() -> Iterator[ServoBus]:
    with ServoBus(servos="XM430-W350:1-3") as bus:
        yield bus


def test_virtual_time_passes_while_the_sdk_waits_for_an_answer(bus: ServoBus) -> None:
    port, packets = bus.open_sdk("dynamixel"), dynamixel_sdk.PacketHandler(2.0)
    assert packets.ping(port, 1) == (1020, dynamixel_sdk.COMM_SUCCESS, 0)
    answered = bus.clock.now()
    assert 0.0005 < answered < 0.002  # 500 us of return delay, and 24 bytes
    assert packets.ping(port, 9)[1] == dynamixel_sdk.COMM_RX_TIMEOUT
    assert TIMEOUT < bus.clock.now() - answered < TIMEOUT + 0.002


def test_a_late_answer_is_waited_for_as_long_as_on_a_real_port(bus: ServoBus) -> None:
    port, packets = bus.open_sdk("dynamixel"), dynamixel_sdk.PacketHandler(2.0)
    bus.faults.late(0.030, rate=1.0)
    assert packets.ping(port, 1)[1] == dynamixel_sdk.COMM_SUCCESS
    bus.faults.clear().late(0.050, rate=1.0)
    assert packets.ping(port, 1)[1] == dynamixel_sdk.COMM_RX_TIMEOUT


def test_a_program_that_polls_sees_time_pass(bus: ServoBus) -> None:
    port = bus.open_sdk("dynamixel")
    port.setPacketTimeoutMillis(2.0)
    while not port.isPacketTimeout():
        pass
    port.writePort(bytes.fromhex("FF FF FD 00 01 03 00 01 19 4E"))
    while port.getBytesAvailable() < 14:
        pass
    assert len(port.readPort(100)) == 14


def test_fast_sync_read_and_protocol_1_work_too(bus: ServoBus) -> None:
    port = bus.open_sdk("dynamixel")
    group = dynamixel_sdk.GroupSyncRead(port, dynamixel_sdk.PacketHandler(2.0), POSITION, 4)
    for servo in (1, 2, 3):
        group.addParam(servo)
    assert group.fastSyncRead() == dynamixel_sdk.COMM_SUCCESS
    assert group.getData(3, POSITION, 4) == 2048
    with ServoBus(servos="MX-28:1") as old:
        ping = dynamixel_sdk.PacketHandler(1.0).ping(old.open_sdk("dynamixel"), 1)
        assert ping == (29, dynamixel_sdk.COMM_SUCCESS, 0)


def test_servos_are_found_at_the_baud_rate_that_they_have() -> None:
    with ServoBus(servos="STS3215:1", baud=115_200) as bus:
        port, packets = bus.open_sdk("feetech"), scservo_sdk.PacketHandler(0)
        assert packets.ping(port, 1)[1] != scservo_sdk.COMM_SUCCESS
        assert port.setBaudRate(115_200)
        assert packets.ping(port, 1)[:2] == (777, scservo_sdk.COMM_SUCCESS)


def test_a_program_that_makes_its_own_port_handler_is_led_to_the_bus(bus: ServoBus) -> None:
    port = bus.port_handler("dynamixel")("/dev/ttyUSB0")
    assert port.openPort() and port.getPortName() == "/dev/ttyUSB0"
    assert isinstance(port, dynamixel_sdk.PortHandler)
    assert dynamixel_sdk.PacketHandler(2.0).ping(port, 1)[1] == dynamixel_sdk.COMM_SUCCESS
    port.closePort()


def test_two_buses_keep_their_own_time(bus: ServoBus) -> None:
    port = bus.open_sdk("dynamixel")
    with ServoBus(servos="XM430-W350:1") as other:
        quick = other.open_sdk("dynamixel")
        dynamixel_sdk.PacketHandler(2.0).ping(port, 9)
        assert bus.clock.now() > TIMEOUT and other.clock.now() == 0.0
        assert quick.getCurrentTime() < 1.0


def test_nothing_is_replaced_in_the_sdk(bus: ServoBus) -> None:
    bus.open_sdk("dynamixel")
    plain = dynamixel_sdk.PortHandler("/dev/null")
    assert abs(plain.getCurrentTime() * 1e-3 - time.time()) < 60.0  # the wall's
    assert plain.getCurrentTime.__func__.__module__ == "dynamixel_sdk.port_handler"


def test_a_bus_closes_what_it_has_opened() -> None:
    with ServoBus(servos="STS3215:1") as bus:
        port = bus.open_sdk("feetech")
    assert not port.is_open


def test_an_unknown_sdk_or_baud_rate_is_named(bus: ServoBus) -> None:
    with pytest.raises(UsageError, match="unknown SDK 'dynamixle'; did you mean 'dynamixel'"):
        bus.open_sdk("dynamixle")  # type: ignore[arg-type]  # the mistake that is tested
    with pytest.raises(UsageError, match="does not support 123 baud"):
        bus.open_sdk("feetech", baud=123)
