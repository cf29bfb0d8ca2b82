import pytest
from hypothesis import given
from hypothesis import strategies as st

from windup.sim_twin.wire.protocols.frames import (
    Frame,
    FrameError,
    Parser,
    crc16,
    encode,
    encode_status,
)

# The manual's examples: emanual.robotis.com/docs/en/dxl/protocol2/
INSTRUCTIONS = {
    "ping": ((1, 0x01, ""), "FFFFFD00 01 0300 01 194E"),
    "ping all": ((254, 0x01, ""), "FFFFFD00 FE 0300 01 3142"),
    "read": ((1, 0x02, "84000400"), "FFFFFD00 01 0700 02 84000400 1D15"),
    "write": ((1, 0x03, "740000020000"), "FFFFFD00 01 0900 03 740000020000 CA89"),
    "reg write": ((1, 0x04, "6800C8000000"), "FFFFFD00 01 0900 04 6800C8000000 AE8E"),
    "action": ((1, 0x05, ""), "FFFFFD00 01 0300 05 02CE"),
    "factory reset": ((1, 0x06, "01"), "FFFFFD00 01 0400 06 01 A1E6"),
    "reboot": ((1, 0x08, ""), "FFFFFD00 01 0300 08 2F4E"),
    "clear": ((1, 0x10, "0144584C22"), "FFFFFD00 01 0800 10 0144584C22 B1DC"),
    "sync read": ((254, 0x82, "840004000102"), "FFFFFD00 FE 0900 82 840004000102 CEFA"),
    "sync write": (
        (254, 0x83, "74000400 0196000000 02AA000000"),
        "FFFFFD00 FE 1100 83 74000400 0196000000 02AA000000 8287",
    ),
    "bulk read": (
        (254, 0x92, "0190000200 0292000100"),
        "FFFFFD00 FE 0D00 92 0190000200 0292000100 1A05",
    ),
    "bulk write": (
        (254, 0x93, "0120000200A000 021F00010050"),
        "FFFFFD00 FE 1000 93 0120000200A000 021F00010050 B768",
    ),
}
STATUSES = {
    "ping": ((1, 0, "060426"), "FFFFFD00 01 0700 55 00 060426 655D"),
    "ping 2": ((2, 0, "060426"), "FFFFFD00 02 0700 55 00 060426 6F6D"),
    "read": ((1, 0, "A6000000"), "FFFFFD00 01 0800 55 00 A6000000 8CC0"),
    "read 2": ((2, 0, "1F080000"), "FFFFFD00 02 0800 55 00 1F080000 BABE"),
    "write": ((1, 0, ""), "FFFFFD00 01 0400 55 00 A10C"),
    "bulk 1": ((1, 0, "7700"), "FFFFFD00 01 0600 55 00 7700 C369"),
    "bulk 2": ((2, 0, "24"), "FFFFFD00 02 0500 55 00 24 8BA9"),
}


@pytest.mark.parametrize("case", INSTRUCTIONS)
def test_the_manuals_instructions_are_made_and_understood(case: str) -> None:
    (identifier, instruction, parameters), text = INSTRUCTIONS[case]
    frame = bytes.fromhex(text)
    assert encode(identifier, instruction, bytes.fromhex(parameters)) == frame
    assert Parser().feed(frame) == [
        Frame(identifier, instruction, bytes.fromhex(parameters), len(frame))
    ]


@pytest.mark.parametrize("case", STATUSES)
def test_the_manuals_answers_are_made(case: str) -> None:
    (identifier, error, parameters), text = STATUSES[case]
    assert encode_status(identifier, error, bytes.fromhex(parameters)) == bytes.fromhex(text)


def test_the_crc_goes_on_where_it_stopped() -> None:
    data = bytes(range(37))
    assert crc16(data[20:], crc16(data[:20])) == crc16(data)


def test_an_unstuffed_header_in_a_payload_is_an_error_though_the_crc_is_right() -> None:
    body = bytes.fromhex("03 7400 FFFFFD00")
    frame = bytes.fromhex("FFFFFD00 01") + (len(body) + 2).to_bytes(2, "little") + body
    frame += crc16(frame).to_bytes(2, "little")
    assert [item.reason for item in Parser().feed(frame) if isinstance(item, FrameError)] == [
        "stuffing"
    ]
    assert not any(isinstance(item, Frame) for item in Parser().feed(frame))


def test_an_unstuffed_header_at_the_end_is_an_error_even_before_a_crc_that_looks_like_it() -> None:
    frames = []
    for low in range(256):  # find parameters whose CRC begins with FD
        body = bytes((3, 0x74, low, 0xFF, 0xFF, 0xFD))
        frame = bytes.fromhex("FFFFFD00 01") + (len(body) + 2).to_bytes(2, "little") + body
        frame += crc16(frame).to_bytes(2, "little")
        frames += [frame] * (frame[-2] == 0xFD)
    for frame in frames:
        assert not any(isinstance(item, Frame) for item in Parser().feed(frame))


def test_a_wrong_crc_is_dropped_and_the_next_frame_is_heard() -> None:
    bad = bytearray(encode(1, 2, b"\x84\x00\x04\x00"))
    bad[9] ^= 0x10
    good = encode(2, 1)
    found = Parser().feed(bytes(bad) + good)
    assert [type(item) for item in found] == [FrameError, Frame]
    assert found[-1].end == len(bad) + len(good)


def test_a_corrupt_length_does_not_swallow_the_frames_behind_it() -> None:
    bad = bytearray(encode(1, 2, b"\x84\x00\x04\x00"))
    bad[6] = 0x03
    found = Parser().feed(bytes(bad) + encode(2, 1) + encode(3, 1))
    assert [item.identifier for item in found if isinstance(item, Frame)] == [2, 3]


PAYLOAD = st.lists(st.sampled_from([0xFF, 0xFD, 0x00, 0x01, 0x55]), max_size=40).map(bytes)


@given(st.lists(st.tuples(st.integers(0, 252), PAYLOAD), max_size=4), st.data())
def test_frames_survive_stuffing_and_any_cut_into_chunks(
    sent: list[tuple[int, bytes]], data: st.DataObject
) -> None:
    stream = b"".join(encode(identifier, 3, payload) for identifier, payload in sent)
    parser, got, at = Parser(), [], 0
    while at < len(stream):
        step = data.draw(st.integers(1, len(stream) - at))
        for item in parser.feed(stream[at : at + step]):
            assert isinstance(item, Frame)
            got.append((item.identifier, item.parameters))
        at += step
    assert got == sent


@given(st.binary(max_size=60))
def test_noise_raises_nothing_and_a_frame_behind_a_pause_is_heard(noise: bytes) -> None:
    parser = Parser()
    parser.feed(noise)
    parser.reset()
    assert [item.end for item in parser.feed(encode(7, 1))] == [10]
