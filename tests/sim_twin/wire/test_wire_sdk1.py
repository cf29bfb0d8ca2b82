"""Unmodified third-party programs on protocol 1 buses, in real time. Nothing here is timed."""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import dynamixel_sdk
import pytest
import rustypot
import scservo_sdk

from tests.sim_twin.wire.emulator_process import emulator

STS = "twin://bench?servos=STS3215-12V:1-3,STS3250:4"
SCS = "twin://bench?servos=SCS0009:1-2"
DXL = "twin://bench?servos=MX-28:1-2,MX-106:3,AX-12A:4&return_delay=0"
TORQUE, GOAL, LOCK, POSITION, SPEED, OFFSET, MODE = 40, 42, 55, 56, 58, 31, 33
PATIENCE = 120.0  # s, for a busy machine
LATENCY = 4000  # ms; the SDKs wait for twice that, where a real adapter would take 16 ms


@pytest.fixture(scope="module")
def paths(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    folder: Path = tmp_path_factory.mktemp("wire1")
    with (
        emulator(STS, folder / "sts") as sts,
        emulator(SCS, folder / "scs") as scs,
        emulator(DXL, folder / "dxl") as dxl,
    ):
        yield {"sts": sts, "scs": scs, "dxl": dxl}


def opened(sdk: Any, path: str) -> Any:
    port = sdk.PortHandler(path)
    port.openPort()
    port.setBaudRate(1_000_000)
    return port


@pytest.fixture
def sts(paths: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    monkeypatch.setattr(scservo_sdk.port_handler, "LATENCY_TIMER", LATENCY)
    port = opened(scservo_sdk, paths["sts"])
    yield port
    port.closePort()


@pytest.fixture
def dxl(paths: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    monkeypatch.setattr(dynamixel_sdk.port_handler, "LATENCY_TIMER", LATENCY)
    port = opened(dynamixel_sdk, paths["dxl"])
    yield port
    port.closePort()


def wait_for(what: Any) -> None:
    deadline = time.monotonic() + PATIENCE
    while not what():
        assert time.monotonic() < deadline


def test_feetechs_sdk_pings_and_scans(sts: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    sdk = scservo_sdk.PacketHandler(0)
    assert [sdk.ping(sts, k)[0] for k in (1, 2, 3, 4)] == [777, 777, 777, 2825]
    monkeypatch.setattr(scservo_sdk.port_handler, "LATENCY_TIMER", 16)
    assert sdk.ping(sts, 5)[1] == scservo_sdk.COMM_RX_TIMEOUT


def test_feetechs_sdk_hands_shakes_as_lerobot_does(sts: Any) -> None:
    """Unlock, set return delay and acceleration, offset and limits, and lock again."""
    sdk = scservo_sdk.PacketHandler(0)
    for k in (1, 2, 3, 4):
        for address, value in ((TORQUE, 0), (LOCK, 0), (7, 0), (85, 254), (41, 254), (MODE, 0)):
            assert sdk.write1ByteTxRx(sts, k, address, value) == (0, 0)
        present = sdk.read2ByteTxRx(sts, k, POSITION)[0]
        offset = scservo_sdk.SCS_TOSCS(present - 2047, 11)
        assert sdk.write2ByteTxRx(sts, k, OFFSET, offset) == (0, 0)
        assert sdk.read2ByteTxRx(sts, k, POSITION)[0] == 2047
        assert sdk.write2ByteTxRx(sts, k, OFFSET, 0) == (0, 0)
        assert sdk.write1ByteTxRx(sts, k, LOCK, 1) == (0, 0)


def test_feetechs_sdk_reads_and_writes_in_groups(sts: Any) -> None:
    sdk = scservo_sdk.PacketHandler(0)
    write = scservo_sdk.GroupSyncWrite(sts, sdk, GOAL, 2)
    read = scservo_sdk.GroupSyncRead(sts, sdk, POSITION, 8)
    goals = {1: 2000, 2: 2050, 3: 2100, 4: 1900}
    for k, goal in goals.items():
        write.addParam(k, list(goal.to_bytes(2, "little")))
        read.addParam(k)
    assert write.txPacket() == scservo_sdk.COMM_SUCCESS

    def there() -> bool:
        assert read.txRxPacket() == scservo_sdk.COMM_SUCCESS
        return all(abs(read.getData(k, POSITION, 2) - goal) < 8 for k, goal in goals.items())

    wait_for(there)
    assert [read.getData(k, 62, 1) for k in goals] == [120] * 4
    assert all(sdk.read1ByteTxRx(sts, k, TORQUE)[0] == 1 for k in goals)


def test_feetechs_sdk_registers_and_acts(sts: Any) -> None:
    sdk = scservo_sdk.PacketHandler(0)
    assert sdk.regWriteTxRx(sts, 1, GOAL, 2, list((2300).to_bytes(2, "little"))) == (0, 0)
    assert sdk.read2ByteTxRx(sts, 1, GOAL)[0] != 2300
    assert sdk.action(sts, scservo_sdk.BROADCAST_ID) == scservo_sdk.COMM_SUCCESS
    wait_for(lambda: abs(sdk.read2ByteTxRx(sts, 1, POSITION)[0] - 2300) < 8)


def test_feetechs_sdk_sees_signs(sts: Any) -> None:
    sdk = scservo_sdk.PacketHandler(0)
    sdk.write1ByteTxRx(sts, 2, MODE, 1)
    sdk.write2ByteTxRx(sts, 2, 46, scservo_sdk.SCS_TOSCS(-800, 15))

    def speed() -> int:
        return int(scservo_sdk.SCS_TOHOST(sdk.read2ByteTxRx(sts, 2, SPEED)[0], 15))

    wait_for(lambda: abs(speed() + 800) < 20)
    assert scservo_sdk.SCS_TOHOST(sdk.read2ByteTxRx(sts, 2, 60)[0], 10) < 0
    sdk.write2ByteTxRx(sts, 2, 46, 0)
    sdk.write1ByteTxRx(sts, 2, TORQUE, 0)
    sdk.write1ByteTxRx(sts, 2, MODE, 0)


def test_feetechs_sdk_on_scs_servos(paths: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scservo_sdk.port_handler, "LATENCY_TIMER", LATENCY)
    port = opened(scservo_sdk, paths["scs"])
    try:
        sdk = scservo_sdk.PacketHandler(1)  # for the whole process
        assert sdk.ping(port, 1)[0] == 1284
        assert sdk.write2ByteTxRx(port, 1, GOAL, 300) == (0, 0)
        wait_for(lambda: abs(sdk.read2ByteTxRx(port, 1, POSITION)[0] - 300) < 6)
    finally:
        scservo_sdk.SCS_SETEND(0)
        port.closePort()


def test_rustypot_on_sts_servos(paths: dict[str, str]) -> None:
    servos = rustypot.Sts3215PyController(serial_port=paths["sts"], baudrate=1_000_000, timeout=8.0)
    wait_for(lambda: servos.scan() == {1: 777, 2: 777, 3: 777, 4: 2825})
    ids, goals = [1, 3], [2200, 1800]
    servos.sync_write_raw_goal_position(ids, goals)
    assert servos.sync_read_raw_goal_position(ids) == goals
    wait_for(
        lambda: (
            servos.sync_read_present_position(ids)
            == pytest.approx([(goal - 2048) * 6.283185 / 4096 for goal in goals], abs=0.02)
        )
    )
    servos.write_lock(1, False)
    before = servos.read_present_position(1)[0]
    servos.write_homing_offset(1, -0.1)
    assert servos.read_homing_offset(1) == pytest.approx([-0.1], abs=1e-3)
    assert servos.read_present_position(1)[0] == pytest.approx(before + 0.1, abs=0.01)
    servos.write_homing_offset(1, 0.0)
    assert servos.read_present_voltage(1) == [120]
    servos.close()


def test_robotis_sdk_on_protocol_1(dxl: Any) -> None:
    sdk = dynamixel_sdk.PacketHandler(1.0)
    assert [sdk.ping(dxl, k)[0] for k in (1, 2, 3, 4)] == [29, 29, 320, 12]
    assert sdk.write2ByteTxRx(dxl, 1, 30, 1700) == (0, 0)
    wait_for(lambda: abs(sdk.read2ByteTxRx(dxl, 1, 36)[0] - 1700) < 5)
    assert sdk.write2ByteTxRx(dxl, 4, 30, 2000) == (0, dynamixel_sdk.ERRBIT_RANGE)
    assert sdk.write2ByteTxRx(dxl, 4, 8, 600) == (0, 0)
    assert sdk.write2ByteTxRx(dxl, 4, 30, 700) == (0, dynamixel_sdk.ERRBIT_ANGLE)
    assert sdk.write1ByteTxRx(dxl, 1, 24, 0) == (0, 0)


def test_robotis_sdk_writes_in_groups_and_reads_in_bulk(dxl: Any) -> None:
    sdk = dynamixel_sdk.PacketHandler(1.0)
    write = dynamixel_sdk.GroupSyncWrite(dxl, sdk, 30, 2)
    for k in (1, 2, 3):
        write.addParam(k, list((1900 + k).to_bytes(2, "little")))
    assert write.txPacket() == dynamixel_sdk.COMM_SUCCESS
    # GroupBulkRead of 4.1.0 hands protocol 1 an argument too many; what it stands on works.
    request = [2, 1, 30, 2, 2, 30, 2, 3, 30]
    assert sdk.bulkReadTx(dxl, request, 9) == dynamixel_sdk.COMM_SUCCESS
    for k in (1, 2, 3):
        data, result, _ = sdk.readRx(dxl, k, 2)
        assert result == dynamixel_sdk.COMM_SUCCESS
        assert int.from_bytes(bytes(data), "little") == 1900 + k


def test_rustypot_on_mx_servos(paths: dict[str, str]) -> None:
    servos = rustypot.MxPyController(serial_port=paths["dxl"], baudrate=1_000_000, timeout=8.0)
    wait_for(lambda: servos.ping(1) and servos.ping(2))
    servos.sync_write_raw_goal_position([1, 2], [2000, 2100])
    assert [servos.read_raw_goal_position(k) for k in (1, 2)] == [[2000], [2100]]
    servos.close()
