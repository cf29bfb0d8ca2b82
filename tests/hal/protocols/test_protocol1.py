import pytest
from hypothesis import given
from hypothesis import strategies as st

from windup.hal.protocols import protocol1
from windup.hal.protocols.protocol2 import Span, Status

POSE = bytes([0x00, 0x08, 0, 0, 0xE8, 0x03])
# Whole frames as the manuals print them: ROBOTIS' of protocol 1, Feetech's of its serial servos.
MANUAL = {
    "ping": (protocol1.ping(1), "FFFF010201FB"),
    "ping status": (protocol1.status(1), "FFFF010200FC"),
    "error status": (protocol1.status(1, error=0x24), "FFFF010224D8"),
    "read": (protocol1.read(1, 43, 1), "FFFF0104022B01CC"),
    "read status": (protocol1.status(1, b"\x20"), "FFFF01030020DB"),
    "write": (protocol1.write(0xFE, 3, b"\x01"), "FFFFFE04030301F6"),
    "write 3": (protocol1.write(1, 12, b"\x64\xaa"), "FFFF0105030C64AADC"),
    "reg write": (protocol1.reg_write(1, 30, b"\xf4\x01"), "FFFF0105041EF401E2"),
    "action": (protocol1.action(), "FFFFFE0205FA"),
    "factory reset": (protocol1.factory_reset(0), "FFFF000206F7"),
    "sync write": (
        protocol1.sync_write({0: b"\x10\x00\x50\x01", 1: b"\x20\x02\x60\x03"}, 30, 4),
        "FFFFFE0E831E04 0010005001 0120026003 67",
    ),
    "bulk read": (
        protocol1.bulk_read([Span(1, 30, 2), Span(2, 36, 2)]),
        "FFFFFE099200 02011E 020224 1D",
    ),
    "bulk status": (protocol1.status(2, b"\x00\x80"), "FFFF0204000080 79"),
    "feetech read": (protocol1.read(1, 56, 2), "FFFF0104023802BE"),
    "feetech read status": (protocol1.status(1, b"\x18\x05"), "FFFF0104001805DD"),
    "feetech write": (protocol1.write(1, 42, POSE), "FFFF0109032A00080000E803D5"),
    "feetech reg write": (protocol1.reg_write(1, 42, POSE), "FFFF0109042A00080000E803D4"),
    "feetech sync read": (protocol1.sync_read([1, 2], 56, 8), "FFFFFE06823808010236"),
    "feetech sync status": (
        protocol1.status(2, bytes.fromhex("FF07000000007723")),
        "FFFF020A00FF070000000077 2353",
    ),
    "feetech sync write": (
        protocol1.sync_write(dict.fromkeys([1, 2, 3, 4], POSE), 42, 6),
        "FFFFFE20832A06 0100080000E803 0200080000E803 0300080000E803 0400080000E803 58",
    ),
    "feetech recovery": (protocol1.factory_reset(1), "FFFF010206F6"),
    "feetech reset": (protocol1.reset_turns(1), "FFFF01020AF2"),
}

payloads = st.binary(max_size=30) | st.lists(
    st.sampled_from([b"\xff", b"\xff\xff", b"\x01", b"\x02", b"\x00"]), max_size=15
).map(b"".join)
statuses = st.builds(Status, st.integers(0, 253), st.integers(0, 127), payloads)


def encoded(item: Status) -> bytes:
    return protocol1.status(item.id, item.params, item.error)


@pytest.mark.parametrize(("frame", "printed"), MANUAL.values(), ids=MANUAL)
def test_a_frame_is_what_the_manual_prints(frame: bytes, printed: str) -> None:
    assert frame == bytes.fromhex(printed)


@given(statuses)
def test_a_frame_sums_to_255_and_comes_back(item: Status) -> None:
    frame = encoded(item)
    assert sum(frame[2:]) % 256 == 255
    assert list(protocol1.find_packets(frame)) == [item]


@given(st.lists(statuses, max_size=5), st.lists(st.binary(max_size=8), min_size=6, max_size=6))
def test_good_frames_are_found_between_noise(items: list[Status], noise: list[bytes]) -> None:
    quiet = [part.replace(b"\xff", b"\xfe") for part in noise]
    stream = quiet[0]
    for item, part in zip(items, quiet[1:], strict=False):
        stream += encoded(item) + part
    assert list(protocol1.find_packets(stream)) == items


@given(st.lists(st.binary(min_size=6, max_size=6), min_size=3, max_size=3), st.binary(max_size=30))
def test_who_knows_what_he_asked_for_finds_it_behind_any_noise(
    data: list[bytes], noise: bytes
) -> None:
    # Noise may hold a whole frame of ours or eat a header: neither is likely, both are possible.
    frames = b"".join(protocol1.status(id + 1, part) for id, part in enumerate(data))
    found = list(protocol1.find_packets(noise + b"\x00" + frames, {1: 6, 2: 6, 3: 6}))
    if not any(noise.count(bytes([id, 8])) for id in (1, 2, 3)):
        assert [item.params for item in found] == data


def test_a_corrupt_length_swallows_nothing() -> None:
    broken = bytearray(protocol1.status(1, bytes(6)))
    broken[3] = 60
    good = protocol1.status(2, bytes(6))
    stream = bytes(broken) + good + bytes(80)
    assert [item.id for item in protocol1.find_packets(stream, {1: 6, 2: 6})] == [2]


def test_a_header_behind_a_stray_ff_is_seen() -> None:
    stream = b"\xff" + protocol1.status(3, b"\xff\xff")
    assert list(protocol1.find_packets(stream)) == [Status(3, 0, b"\xff\xff")]


def test_an_echo_of_the_request_is_no_answer() -> None:
    stream = protocol1.sync_read([1], 56, 6) + protocol1.status(1, bytes(6))
    assert [item.id for item in protocol1.find_packets(stream, {1: 6})] == [1]


@given(st.binary(max_size=200))
def test_no_stream_raises(stream: bytes) -> None:
    list(protocol1.find_packets(stream))
    list(protocol1.find_packets(stream, {1: 6, 255: 4}))


@given(statuses, st.integers(1, 60))
def test_a_cut_frame_is_no_frame(item: Status, cut: int) -> None:
    frame = encoded(item)
    rest = frame[: -min(cut, len(frame))]
    assert item not in list(protocol1.find_packets(rest))


@given(st.integers(1, 60), st.integers(1, 6))
def test_no_frame_of_a_split_write_is_too_long_and_nothing_is_lost(servos: int, size: int) -> None:
    data = {id: bytes([id] * size) for id in range(servos)}
    frames = protocol1.split_sync_write(data, 42, size, protocol1.LONGEST_FEETECH)
    assert all(len(frame) <= protocol1.LONGEST_FEETECH for frame in frames)
    bodies = b"".join(frame[7:-1] for frame in frames)
    assert bodies == b"".join(bytes([id]) + value for id, value in data.items())
    assert all(frame == bytes(protocol1.frame(0xFE, 0x83, frame[5:-1])) for frame in frames)
