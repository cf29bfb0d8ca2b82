"""Our protocol 1 against dynamixel-sdk and feetech-servo-sdk, on the same fake wire."""

import pytest
import scservo_sdk
from dynamixel_sdk import GroupBulkRead, Protocol1PacketHandler
from dynamixel_sdk import GroupSyncWrite as DynamixelSyncWrite
from hypothesis import given
from hypothesis import strategies as st
from scservo_sdk.protocol_packet_handler import protocol_packet_handler

from tests.hal.fake_bus1 import MX, SCS, STS, fake_port1
from windup.hal.errors import (
    CorruptAnswerError,
    NoAnswerError,
    PortError,
    ServoRejectionError,
    UsageError,
)
from windup.hal.families import DYNAMIXEL_1, FEETECH_SCS, FEETECH_STS, Family
from windup.hal.families.configurator import SdkPort
from windup.hal.protocols import protocol1
from windup.hal.protocols.protocol2 import Span
from windup.hal.servos.servo_model import ServoModel

IDS = [1, 2, 3]


def test_feetechs_sdk_reads_and_writes_the_frames_that_we_build() -> None:
    serial, port = fake_port1(dict.fromkeys(IDS, STS))
    for id in IDS:
        serial.set(id, "present_position", 100 * id)
    packets = protocol_packet_handler()
    sync = scservo_sdk.GroupSyncRead(SdkPort(port), packets, 56, 6)
    write = scservo_sdk.GroupSyncWrite(SdkPort(port), packets, 42, 2)
    data = {id: bytes([id, 1]) for id in IDS}
    for id in IDS:
        sync.addParam(id)
        write.addParam(id, data[id])
    assert sync.txRxPacket() == scservo_sdk.COMM_SUCCESS
    assert [sync.getData(id, 56, 2) for id in IDS] == [100, 200, 300]
    assert serial.requests[-1] == protocol1.sync_read(IDS, 56, 6)
    assert write.txPacket() == scservo_sdk.COMM_SUCCESS
    assert serial.requests[-1] == protocol1.sync_write(data, 42, 2)


def test_dynamixels_sdk_reads_and_writes_the_frames_that_we_build() -> None:
    serial, port = fake_port1(dict.fromkeys(IDS, MX))
    packets = Protocol1PacketHandler()
    bulk = GroupBulkRead(SdkPort(port), packets)
    write = DynamixelSyncWrite(SdkPort(port), packets, 30, 2)
    data = {id: bytes([id, 1]) for id in IDS}
    for id in IDS:
        bulk.addParam(id, 36, 6)
        write.addParam(id, data[id])
    bulk.makeParam()
    # Its own txPacket raises TypeError in protocol 1: one argument too many.
    assert packets.bulkReadTx(bulk.port, bulk.param, len(bulk.param)) == 0
    assert bulk.rxPacket() == 0
    assert [bulk.getData(id, 36, 2) for id in IDS] == [2048] * 3
    assert serial.requests[-1] == protocol1.bulk_read([Span(id, 36, 6) for id in IDS])
    assert write.txPacket() == 0
    assert serial.requests[-1] == protocol1.sync_write(data, 30, 2)


@given(st.binary(min_size=1, max_size=20))
def test_bytes_survive_both_links(data: bytes) -> None:
    for family, model in ((FEETECH_STS, STS), (DYNAMIXEL_1, MX)):
        _, port = fake_port1({1: model})
        configurator = family.protocol.configurator(port)
        configurator.write(1, 80, data)
        assert configurator.read(1, 80, len(data)) == data


def test_the_process_global_byte_order_touches_nobody() -> None:
    _, port = fake_port1({1: STS})
    _, other = fake_port1({1: SCS})
    for end in (0, 1):
        scservo_sdk.SCS_SETEND(end)
        try:
            assert FEETECH_STS.protocol.configurator(port).ping(1) == 777
            assert FEETECH_SCS.protocol.configurator(other).ping(1) == 1284
        finally:
            scservo_sdk.SCS_SETEND(0)


@pytest.mark.parametrize(("family", "model"), [(FEETECH_STS, STS), (DYNAMIXEL_1, MX)])
def test_silence_takes_virtual_time_only_and_noise_is_named(
    family: Family, model: ServoModel
) -> None:
    serial, port = fake_port1({1: model})
    configurator = family.protocol.configurator(port)
    serial.silent.add(1)
    before = serial.clock.now()
    with pytest.raises(NoAnswerError, match=r"no answer from id 1 on fake://bus at 1000000 baud"):
        configurator.ping(1)
    assert 0.0 < serial.clock.now() - before < 0.1
    serial.silent.clear()
    serial.spoil = lambda id, frame: bytes([*frame[:-1], frame[-1] ^ 4])
    with pytest.raises(CorruptAnswerError, match="two servos with this id"):
        configurator.ping(1)


def test_a_short_answer_is_no_answer() -> None:
    serial, port = fake_port1({1: STS})
    serial.spoil = lambda id, frame: protocol1.status(id, b"\x07")
    with pytest.raises(CorruptAnswerError, match="only corrupt answers"):
        FEETECH_STS.protocol.configurator(port).read(1, 56, 2)


def test_a_dynamixel_refuses_and_an_overload_is_no_refusal() -> None:
    serial, port = fake_port1({1: MX})
    serial.error[1] = 0x08
    configurator = DYNAMIXEL_1.protocol.configurator(port)
    with pytest.raises(
        ServoRejectionError, match="id 1 on fake://bus says the value is out of range"
    ):
        configurator.write(1, 30, b"\xff\xff")
    serial.error[1] = 0x20
    assert configurator.ping(1) == 29


def test_a_late_reply_is_not_taken_for_the_next_answer() -> None:
    serial, port = fake_port1({1: STS})
    serial.set(1, "present_position", 77)
    late = protocol1.status(1, b"\x09\x09")
    serial.arrivals = [(serial.clock.time, byte) for byte in late]
    assert FEETECH_STS.protocol.configurator(port).read(1, 56, 2) == bytes([77, 0])


def test_an_exception_leaves_the_port_usable() -> None:
    serial, port = fake_port1({1: STS})
    configurator = FEETECH_STS.protocol.configurator(port)

    def unplugged(size: int = 1) -> bytes:
        raise OSError("device reports readiness to read but returned no data")

    read, serial.read = serial.read, unplugged  # type: ignore[method-assign]
    with pytest.raises(PortError, match="was disconnected"):
        configurator.ping(1)
    serial.read = read  # type: ignore[method-assign]
    assert configurator.ping(1) == 777


def test_protocol_1_has_no_reboot() -> None:
    _, port = fake_port1({1: MX})
    with pytest.raises(UsageError, match="switch its power off and on"):
        DYNAMIXEL_1.protocol.configurator(port).reboot(1)
