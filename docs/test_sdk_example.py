"""Five tests of a program for servos, with its maker's own SDK and without servos.

Ping, sync read, dropouts, overload, unplugging: for Dynamixel (dynamixel_sdk), then for Feetech
(scservo_sdk). Run it with `pytest docs/test_sdk_example.py`. Time is virtual: it passes while the
SDK waits for an answer, and in `bus.wait`.
"""

import termios

import dynamixel_sdk as dxl
import pytest
import scservo_sdk as scs
from serial import SerialException

X_TORQUE, X_ERROR, X_POSITION = 64, 70, 132  # registers of a Dynamixel X servo
STS_TORQUE, STS_POSITION = 40, 56  # registers of a Feetech STS servo
ALERT = 0x80  # bit of a Dynamixel's error byte: look at Hardware Error Status
UNPLUGGED = (SerialException, termios.error)  # by the call; a termios.error is no OSError
OVERLOAD = 0x20  # bit of Hardware Error Status, and of a Feetech servo's error byte


@pytest.fixture
def x_bus(servo_bus):
    return servo_bus(servos="XM430-W350:1-3", seed=1)


@pytest.fixture
def x_port(x_bus):
    return x_bus.open_sdk("dynamixel")  # a dynamixel_sdk.PortHandler, open at 1 Mbaud


def test_dynamixel_ping(x_port):
    packets = dxl.PacketHandler(2.0)
    assert packets.ping(x_port, 1) == (1020, dxl.COMM_SUCCESS, 0)  # the model number of an XM430
    assert packets.ping(x_port, 9)[1] == dxl.COMM_RX_TIMEOUT


def test_dynamixel_sync_read(x_port):
    group = dxl.GroupSyncRead(x_port, dxl.PacketHandler(2.0), X_POSITION, 4)
    for servo in (1, 2, 3):
        group.addParam(servo)
    assert group.txRxPacket() == dxl.COMM_SUCCESS
    assert [group.getData(servo, X_POSITION, 4) for servo in (1, 2, 3)] == [2048] * 3


def test_dynamixel_dropouts(x_bus, x_port):
    packets = dxl.PacketHandler(2.0)
    x_bus.faults.drop(rate=0.2)
    results = [packets.read4ByteTxRx(x_port, 1, X_POSITION)[1] for _ in range(50)]
    lost = results.count(dxl.COMM_RX_TIMEOUT)
    assert lost == x_bus.faults.counts["drop"] > 0
    assert results.count(dxl.COMM_SUCCESS) == 50 - lost


def test_dynamixel_overload(x_bus, x_port):
    packets = dxl.PacketHandler(2.0)
    packets.write1ByteTxRx(x_port, 2, X_TORQUE, 1)
    x_bus.faults.overload(ids=[2])  # now
    x_bus.wait(0.02)
    assert packets.ping(x_port, 2)[2] & ALERT
    assert packets.read1ByteTxRx(x_port, 2, X_ERROR)[0] == OVERLOAD
    assert packets.read1ByteTxRx(x_port, 2, X_TORQUE)[0] == 0  # it has let go
    assert packets.ping(x_port, 1)[2] == 0  # the others have not noticed


def test_dynamixel_unplug(x_bus, x_port):
    packets = dxl.PacketHandler(2.0)
    x_bus.faults.unplug(seconds=0.5)  # now, and back after half a second
    with pytest.raises(UNPLUGGED):
        packets.ping(x_port, 1)
    x_bus.wait(0.6)
    x_port.is_using = False  # the SDK leaves that set behind an exception
    assert x_port.openPort()
    assert packets.ping(x_port, 1)[1] == dxl.COMM_SUCCESS


@pytest.fixture
def sts_bus(servo_bus):
    return servo_bus(servos="STS3215:1-3", seed=1)


@pytest.fixture
def sts_port(sts_bus):
    return sts_bus.open_sdk("feetech")  # a scservo_sdk.PortHandler


def test_feetech_ping(sts_port):
    packets = scs.PacketHandler(0)
    assert packets.ping(sts_port, 1) == (777, scs.COMM_SUCCESS, 0)
    assert packets.ping(sts_port, 9)[1] == scs.COMM_RX_TIMEOUT


def test_feetech_sync_read(sts_port):
    group = scs.GroupSyncRead(sts_port, scs.PacketHandler(0), STS_POSITION, 2)
    for servo in (1, 2, 3):
        group.addParam(servo)
    assert group.txRxPacket() == scs.COMM_SUCCESS
    assert [group.getData(servo, STS_POSITION, 2) for servo in (1, 2, 3)] == [2048] * 3


def test_feetech_dropouts(sts_bus, sts_port):
    packets = scs.PacketHandler(0)
    sts_bus.faults.drop(rate=0.2)
    results = [packets.read2ByteTxRx(sts_port, 1, STS_POSITION)[1] for _ in range(50)]
    lost = results.count(scs.COMM_RX_TIMEOUT)
    assert lost == sts_bus.faults.counts["drop"] > 0
    assert results.count(scs.COMM_SUCCESS) == 50 - lost


def test_feetech_overload(sts_bus, sts_port):
    packets = scs.PacketHandler(0)
    packets.write1ByteTxRx(sts_port, 2, STS_TORQUE, 1)
    sts_bus.faults.overload(ids=[2])
    sts_bus.wait(0.02)
    assert packets.read2ByteTxRx(sts_port, 2, STS_POSITION)[2] & OVERLOAD
    assert packets.write1ByteTxRx(sts_port, 2, STS_TORQUE, 0)[1] == scs.COMM_SUCCESS
    assert not sts_bus.servo(2).driving


def test_feetech_unplug(sts_bus, sts_port):
    packets = scs.PacketHandler(0)
    sts_bus.faults.unplug(seconds=0.5)
    with pytest.raises(UNPLUGGED):
        packets.ping(sts_port, 1)
    sts_bus.wait(0.6)
    sts_port.is_using = False
    assert sts_port.openPort()
    assert packets.ping(sts_port, 1)[1] == scs.COMM_SUCCESS
