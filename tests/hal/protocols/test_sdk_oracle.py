"""Our codec against dynamixel-sdk: two programs that have never seen each other."""

from typing import Any

import pytest
from dynamixel_sdk import COMM_SUCCESS, GroupSyncRead, GroupSyncWrite, Protocol2PacketHandler
from hypothesis import given
from hypothesis import strategies as st

from tests.hal.fake_bus import fake_port
from windup.hal.errors import CorruptAnswerError, NoAnswerError, PortError, ServoRejectionError
from windup.hal.families.configurator import DynamixelConfigurator, SdkPackets, SdkPort
from windup.hal.protocols import protocol2
from windup.hal.protocols.crc16 import crc16

IDS = [1, 2, 3]
HEADER_IN_DATA = bytes.fromhex("fffffd00")


def test_the_sdk_reads_what_our_frames_say() -> None:
    serial, port = fake_port(IDS)
    for id in IDS:
        serial.put(id, 132, 100 * id, 4)
    sync = GroupSyncRead(SdkPort(port), SdkPackets(), 132, 4)
    for id in IDS:
        sync.addParam(id)
    assert sync.txRxPacket() == COMM_SUCCESS
    assert [sync.getData(id, 132, 4) for id in IDS] == [100, 200, 300]
    assert serial.requests[-1] == protocol2.sync_read(IDS, 132, 4)
    assert sync.fastSyncRead() == COMM_SUCCESS
    assert [sync.getData(id, 132, 4) for id in IDS] == [100, 200, 300]
    assert serial.requests[-1] == protocol2.sync_read(IDS, 132, 4, fast=True)


def test_the_sdk_writes_the_frames_that_we_build() -> None:
    serial, port = fake_port(IDS)
    sync = GroupSyncWrite(SdkPort(port), SdkPackets(), 116, 4)
    data = {id: bytes([id, 1, 0, 0]) for id in IDS}
    for id, value in data.items():
        sync.addParam(id, value)
    assert sync.txPacket() == COMM_SUCCESS
    assert serial.requests == [protocol2.sync_write(data, 116, 4)]


@given(st.binary(min_size=1, max_size=30))
def test_the_sdk_computes_the_same_crc(data: bytes) -> None:
    ours = crc16(data)
    assert Protocol2PacketHandler().updateCRC(0, data, len(data)) == ours


@pytest.mark.parametrize("handler", [Protocol2PacketHandler, SdkPackets])
def test_the_repaired_handler_stuffs_what_it_sends(handler: Any) -> None:
    serial, port = fake_port(IDS)
    handler().writeTxRx(SdkPort(port), 1, 116, 4, list(HEADER_IN_DATA))
    wire = protocol2.write(1, 116, HEADER_IN_DATA)
    # The first is the defect, still there in the installed package.
    assert (serial.requests[0] == wire) == (handler is SdkPackets)


@given(st.lists(st.sampled_from([0xFF, 0xFD, 0]), min_size=8, max_size=8).map(bytes))
def test_a_payload_full_of_headers_survives_the_link(data: bytes) -> None:
    _, port = fake_port(IDS)
    link = DynamixelConfigurator(port)
    link.write(1, 200, data)
    assert link.read(1, 200, 8) == data


def test_time_passes_on_the_ports_clock_only() -> None:
    serial, port = fake_port(IDS)
    serial.silent.add(1)
    before = serial.clock.now()
    with pytest.raises(NoAnswerError, match=r"no answer from id 1 on fake://bus at 1000000 baud"):
        DynamixelConfigurator(port).ping(1)
    assert 0.0 < serial.clock.now() - before < 0.1


def test_two_servos_with_one_id_are_named_as_such() -> None:
    serial, port = fake_port(IDS)
    serial.spoil = lambda id, frame: bytes([*frame[:-3], frame[-3] ^ 4, *frame[-2:]])
    with pytest.raises(CorruptAnswerError, match="two servos with this id"):
        DynamixelConfigurator(port).ping(2)


def test_a_refusal_says_why() -> None:
    serial, port = fake_port(IDS)
    serial.error[2] = 7
    with pytest.raises(
        ServoRejectionError, match=r"id 2 on fake://bus says the register is locked"
    ):
        DynamixelConfigurator(port).write(2, 9, b"\x00")


def test_an_alert_is_no_refusal() -> None:
    serial, port = fake_port(IDS)
    serial.error[2] = 0x80
    assert DynamixelConfigurator(port).ping(2) == 1020


def test_an_exception_leaves_the_port_usable() -> None:
    serial, port = fake_port(IDS)
    link = DynamixelConfigurator(port)
    read, serial.read = serial.read, _unplugged  # type: ignore[method-assign]
    with pytest.raises(PortError, match="was disconnected"):
        link.ping(1)
    serial.read = read  # type: ignore[method-assign]
    assert link.ping(1) == 1020


def test_the_answer_of_another_id_is_skipped() -> None:
    serial, port = fake_port(IDS)
    stranger = protocol2.status(99, bytes(4))
    serial.spoil = lambda id, frame: stranger + frame
    serial.put(1, 132, 77, 4)
    before = serial.clock.now()
    assert DynamixelConfigurator(port).read(1, 132, 4) == bytes([77, 0, 0, 0])
    assert serial.clock.now() - before < 2e-3


def _unplugged(size: int = 1) -> bytes:
    raise OSError("device reports readiness to read but returned no data")
