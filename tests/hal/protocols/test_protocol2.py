import pytest
from hypothesis import given
from hypothesis import strategies as st

from windup.hal.protocols import protocol2
from windup.hal.protocols.crc16 import crc16, distance_table
from windup.hal.protocols.protocol2 import Span, Status

# Whole frames as ROBOTIS' manual of protocol 2 prints them.
MANUAL = {
    "ping": (protocol2.ping(1), "FFFFFD0001030001194E"),
    "broadcast ping": (protocol2.ping(), "FFFFFD00FE0300013142"),
    "ping status": (protocol2.status(1, bytes([6, 4, 0x26])), "FFFFFD000107005500060426655D"),
    "ping status 2": (protocol2.status(2, bytes([6, 4, 0x26])), "FFFFFD0002070055000604266F6D"),
    "read": (protocol2.read(1, 132, 4), "FFFFFD00010700028400 04001D15"),
    "read status": (protocol2.status(1, bytes([0xA6, 0, 0, 0])), "FFFFFD000108005500A60000008CC0"),
    "write": (
        protocol2.write(1, 116, (512).to_bytes(4, "little")),
        "FFFFFD00010900037400 00020000CA89",
    ),
    "write status": (protocol2.status(1), "FFFFFD00010400 5500A10C"),
    "reg write": (
        protocol2.reg_write(1, 104, (200).to_bytes(4, "little")),
        "FFFFFD00010900046800C8000000AE8E",
    ),
    "action": (protocol2.action(1), "FFFFFD000103000502CE"),
    "factory reset": (protocol2.factory_reset(1, 0x01), "FFFFFD0001040006 01A1E6"),
    "reboot": (protocol2.reboot(1), "FFFFFD00010300082F4E"),
    "sync read": (protocol2.sync_read([1, 2], 132, 4), "FFFFFD00FE0900828400 04000102CEFA"),
    "fast sync read": (
        protocol2.sync_read([3, 7, 4], 132, 4, fast=True),
        "FFFFFD00FE0A008A84000400030704 20F2",
    ),
    "sync write": (
        protocol2.sync_write({1: bytes([150, 0, 0, 0]), 2: bytes([170, 0, 0, 0])}, 116, 4),
        "FFFFFD00FE1100837400 0400 0196000000 02AA000000 8287",
    ),
    "bulk read": (
        protocol2.bulk_read([Span(1, 144, 2), Span(2, 146, 1)]),
        "FFFFFD00FE0D0092 0190000200 0292000100 1A05",
    ),
}
FAST_ANSWER = bytes.fromhex(
    "FFFFFD00FE190055 0003A6000000 8408 00071F080000 16CA"
)  # the manual's blocks of ids 3 and 7; that of id 4 is built in the test

payloads = st.binary(max_size=40) | st.lists(
    st.sampled_from([b"\xff", b"\xfd", b"\xff\xff\xfd", b"\x00", b"\x01"]), max_size=20
).map(b"".join)
statuses = st.builds(Status, st.integers(0, 252), st.integers(0, 255), payloads)


def headers(data: bytes) -> list[int]:
    return [at for at in range(len(data)) if data.startswith(b"\xff\xff\xfd", at)]


def encoded(item: Status) -> bytes:
    return protocol2.status(item.id, item.params, item.error)


@pytest.mark.parametrize(("frame", "printed"), MANUAL.values(), ids=MANUAL)
def test_a_frame_is_what_the_manual_prints(frame: bytes, printed: str) -> None:
    assert frame == bytes.fromhex(printed)


def test_each_block_of_a_fast_answer_is_checked_by_itself() -> None:
    answer = FAST_ANSWER + bytes([0, 4, 0xFF, 3, 0, 0])
    answer += crc16(answer).to_bytes(2, "little")
    values = [
        int.from_bytes(item.params, "little")
        for item in protocol2.find_fast_packets(answer, 4, (3, 7, 4))
    ]
    assert values == [166, 2079, 1023]
    broken = bytearray(answer)
    broken[18] ^= 1  # a byte of id 7
    assert [item.id for item in protocol2.find_fast_packets(bytes(broken), 4, (3, 7, 4))] == [3, 4]


@given(payloads)
def test_unstuffing_is_the_inverse_of_stuffing(payload: bytes) -> None:
    stuffed = protocol2.stuff(payload)
    assert protocol2.unstuff(stuffed) == payload
    assert all(stuffed[at + 3 : at + 4] == b"\xfd" for at in headers(stuffed))


@given(payloads, payloads)
def test_the_crc_is_the_xor_of_its_bytes_by_distance(one: bytes, other: bytes) -> None:
    table = distance_table(64 + 16)
    data = (one + other)[:80]
    total = 0
    for place, byte in enumerate(data):
        total ^= int(table[len(data) - 1 - place, byte])
    assert total == crc16(data)


@given(st.lists(statuses, max_size=5), st.lists(st.binary(max_size=8), min_size=6, max_size=6))
def test_good_frames_are_found_between_noise(items: list[Status], noise: list[bytes]) -> None:
    # Noise that begins a header may eat into the next frame's header; none of it does here.
    quiet = [part.replace(b"\xff", b"\xfe") for part in noise]
    stream = quiet[0]
    for item, part in zip(items, quiet[1:], strict=False):
        stream += encoded(item) + part
    assert list(protocol2.find_packets(stream)) == items


@given(st.lists(statuses, min_size=2, max_size=5), st.data())
def test_a_broken_frame_costs_no_other(items: list[Status], data: st.DataObject) -> None:
    frames = [encoded(item) for item in items]
    victim = data.draw(st.integers(0, len(items) - 1))
    place = data.draw(st.integers(0, len(frames[victim]) - 1))
    flip = data.draw(st.integers(1, 255))
    broken = bytearray(frames[victim])
    broken[place] ^= flip
    frames[victim] = bytes(broken)
    rest = items[:victim] + items[victim + 1 :]
    found = list(protocol2.find_packets(b"".join(frames)))
    assert [item for item in found if item in rest] == rest


@given(st.binary(max_size=200))
def test_no_stream_raises(stream: bytes) -> None:
    list(protocol2.find_packets(stream))
    list(protocol2.find_fast_packets(stream, 4, range(9)))


@given(statuses, st.integers(1, 60))
def test_a_cut_frame_is_no_frame(item: Status, cut: int) -> None:
    frame = encoded(item)
    assert list(protocol2.find_packets(frame[: -min(cut, len(frame))])) == []


def test_a_corrupt_length_swallows_nothing() -> None:
    broken = bytearray(protocol2.status(1, bytes(4)))
    broken[5] = 60
    good = protocol2.status(2, bytes(4))
    assert [item.id for item in protocol2.find_packets(bytes(broken) + good)] == [2]


def test_an_echo_of_the_request_is_skipped() -> None:
    stream = protocol2.sync_read([1], 132, 4) + protocol2.status(1, bytes(4))
    assert [item.id for item in protocol2.find_packets(stream)] == [1]
