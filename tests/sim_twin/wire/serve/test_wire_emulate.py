"""Unmodified third-party programs on an emulated bus, in real time. Nothing here is timed."""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import dynamixel_sdk
import pytest
import rustypot
import serial

from tests.sim_twin.wire.emulator_process import emulator
from windup.sim_twin.wire.protocols.frames import encode

BUS = "twin://bench?servos=XL430-W250:1-3,XM430-W350:4&return_delay=0"
POSITION = 132
GOAL = 116
TORQUE = 64


@pytest.fixture(scope="module")
def pty(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    path: Path = tmp_path_factory.mktemp("wire") / "servos"
    with emulator(BUS, path) as name:
        assert name == str(path)
        yield name
    assert not path.exists()


@pytest.fixture
def port(pty: str, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    # The SDK's patience is 34 ms, which a busy machine may well need for something else.
    monkeypatch.setattr(dynamixel_sdk.port_handler, "LATENCY_TIMER", 250)
    handler = dynamixel_sdk.PortHandler(pty)
    handler.openPort()
    handler.setBaudRate(1_000_000)
    yield handler
    handler.closePort()


@pytest.fixture
def sdk() -> Any:
    return dynamixel_sdk.PacketHandler(2.0)


def test_the_sdk_pings_reads_writes_and_sees_errors(port: Any, sdk: Any) -> None:
    assert sdk.ping(port, 1)[:2] == (1060, dynamixel_sdk.COMM_SUCCESS)
    assert sdk.ping(port, 99)[1] == dynamixel_sdk.COMM_RX_TIMEOUT
    assert sdk.read4ByteTxRx(port, 1, POSITION) == (2048, 0, 0)
    assert sdk.write4ByteTxRx(port, 1, GOAL, 2100) == (0, 0)
    assert sdk.read4ByteTxRx(port, 1, GOAL) == (2100, 0, 0)
    assert sdk.write4ByteTxRx(port, 1, GOAL, 5000) == (0, dynamixel_sdk.ERRNUM_DATA_LIMIT)
    assert sdk.write1ByteTxRx(port, 1, TORQUE, 1) == (0, 0)
    assert sdk.write1ByteTxRx(port, 1, 11, 4) == (0, dynamixel_sdk.ERRNUM_ACCESS)
    assert sdk.write1ByteTxRx(port, 1, TORQUE, 0) == (0, 0)


def test_the_sdk_scans_by_broadcast(port: Any, sdk: Any) -> None:
    # The SDK's own patience for a broadcast cannot be raised: give a busy machine a few goes.
    for _ in range(10):
        found, result = sdk.broadcastPing(port)
        if result == dynamixel_sdk.COMM_SUCCESS and len(found) == 4:
            break
    assert result == dynamixel_sdk.COMM_SUCCESS
    assert {k: model for k, (model, _) in found.items()} == {1: 1060, 2: 1060, 3: 1060, 4: 1020}


@pytest.mark.parametrize("fast", [False, True])
def test_the_sdk_reads_and_writes_in_groups(port: Any, sdk: Any, fast: bool) -> None:
    write = dynamixel_sdk.GroupSyncWrite(port, sdk, GOAL, 4)
    read = dynamixel_sdk.GroupSyncRead(port, sdk, GOAL, 4)
    for k in (1, 2, 3, 4):
        write.addParam(k, (1000 + k).to_bytes(4, "little"))
        read.addParam(k)
    assert write.txPacket() == dynamixel_sdk.COMM_SUCCESS
    result = read.fastSyncRead() if fast else read.txRxPacket()
    assert result == dynamixel_sdk.COMM_SUCCESS
    assert [read.getData(k, GOAL, 4) for k in (1, 2, 3, 4)] == [1001, 1002, 1003, 1004]


def test_the_sdk_reads_and_writes_in_bulk(port: Any, sdk: Any) -> None:
    write = dynamixel_sdk.GroupBulkWrite(port, sdk)
    write.addParam(1, 65, 1, [1])
    write.addParam(4, GOAL, 4, list((1500).to_bytes(4, "little")))
    assert write.txPacket() == dynamixel_sdk.COMM_SUCCESS
    read = dynamixel_sdk.GroupBulkRead(port, sdk)
    read.addParam(1, 65, 1)
    read.addParam(4, GOAL, 4)
    assert read.txRxPacket() == dynamixel_sdk.COMM_SUCCESS
    assert (read.getData(1, 65, 1), read.getData(4, GOAL, 4)) == (1, 1500)


def test_the_sdk_registers_acts_moves_and_reboots(port: Any, sdk: Any) -> None:
    assert sdk.write1ByteTxRx(port, 2, TORQUE, 1) == (0, 0)
    assert sdk.regWriteTxRx(port, 2, GOAL, 4, list((2400).to_bytes(4, "little"))) == (0, 0)
    sdk.action(port, 2)
    time.sleep(0.05)  # the SDK does not wait for the answer, and would take it for the next one
    deadline = time.monotonic() + 20.0
    while abs(sdk.read4ByteTxRx(port, 2, POSITION)[0] - 2400) > 60:
        assert time.monotonic() < deadline
    assert sdk.reboot(port, 2) == (0, 0)
    while sdk.ping(port, 2)[1] != dynamixel_sdk.COMM_SUCCESS:
        assert time.monotonic() < deadline
    assert sdk.read1ByteTxRx(port, 2, TORQUE) == (0, 0, 0)


def test_the_sdk_changes_id_and_baud_rate(port: Any, sdk: Any) -> None:
    assert sdk.write1ByteTxRx(port, 3, 7, 33) == (0, 0)
    assert sdk.write1ByteTxRx(port, 33, 8, 4) == (0, 0)
    assert sdk.ping(port, 33)[1] != dynamixel_sdk.COMM_SUCCESS
    port.setBaudRate(2_000_000)
    assert sdk.ping(port, 33)[0] == 1060
    assert sdk.ping(port, 1)[1] != dynamixel_sdk.COMM_SUCCESS
    assert sdk.write1ByteTxRx(port, 33, 7, 3) == (0, 0)
    assert sdk.write1ByteTxRx(port, 3, 8, 3) == (0, 0)
    port.setBaudRate(1_000_000)
    assert sdk.ping(port, 3)[0] == 1060


def test_rustypot_scans_reads_writes_and_reboots(pty: str) -> None:
    servos = rustypot.Xl330PyController(serial_port=pty, baudrate=1_000_000, timeout=0.5)
    deadline = time.monotonic() + 20.0
    while servos.scan() != {1: 1060, 2: 1060, 3: 1060, 4: 1020}:
        assert time.monotonic() < deadline
    assert servos.ping(1) and not servos.ping(9)
    ids, goals = [1, 2, 3], [2000, 2001, 2002]
    servos.sync_write_raw_goal_position(ids, goals)
    for fast in (False, True):
        servos.set_fast_sync_read(fast)
        assert servos.sync_read_raw_goal_position(ids) == goals
    angles = servos.sync_read_goal_position(ids)
    assert angles == pytest.approx([(goal - 2048) * 6.283185 / 4096 for goal in goals], abs=2e-3)
    servos.write_torque_enable(1, True)
    servos.reboot(1)
    while not servos.ping(1):
        assert time.monotonic() < deadline
    assert not servos.read_torque_enable(1)[0]
    servos.close()


def test_a_tcp_port_serves_pyserial() -> None:
    with emulator("twin://op3") as url:
        with serial.serial_for_url(url, timeout=5.0) as port:
            port.write(encode(200, 1))
            assert len(port.read(14)) == 14
        with serial.serial_for_url(url, timeout=5.0) as port:
            port.write(encode(1, 1))
            assert len(port.read(14)) == 14
