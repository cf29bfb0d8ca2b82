"""Frames of protocol 1, against the makers' manuals and against noise."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from windup.sim_twin.wire.protocols.frames1 import (
    Frame1,
    Frame1Error,
    Parser1,
    encode,
    with_checksum,
)

# ROBOTIS e-Manual, protocol 1; Feetech's manual of its serial protocol.
MANUALS = [
    ("ping", "FF FF 01 02 01 FB", 1, 1, ""),
    ("read temperature", "FF FF 01 04 02 2B 01 CC", 1, 2, "2B 01"),
    ("write id to all", "FF FF FE 04 03 03 01 F6", 254, 3, "03 01"),
    ("reset", "FF FF 00 02 06 F7", 0, 6, ""),
    ("bulk read", "FF FF FE 09 92 00 02 01 1E 02 02 24 1D", 254, 0x92, "00 02 01 1E 02 02 24"),
    ("feetech write id", "FF FF FE 04 03 05 01 F4", 254, 3, "05 01"),
    ("feetech read position", "FF FF 01 04 02 38 02 BE", 1, 2, "38 02"),
    ("feetech goal", "FF FF 01 09 03 2A 00 08 00 00 E8 03 D5", 1, 3, "2A 00 08 00 00 E8 03"),
    ("feetech reg write", "FF FF 01 09 04 2A 00 08 00 00 E8 03 D4", 1, 4, "2A 00 08 00 00 E8 03"),
    ("feetech action", "FF FF FE 02 05 FA", 254, 5, ""),
    ("feetech status", "FF FF 01 0A 00 00 08 00 00 00 00 79 1E 55", 1, 0, "0008 00000000 791E"),
]


@pytest.mark.parametrize(
    ("frame", "identifier", "instruction", "parameters"),
    [row[1:] for row in MANUALS],
    ids=[row[0] for row in MANUALS],
)
def test_the_manuals_frames(frame: str, identifier: int, instruction: int, parameters: str) -> None:
    raw, wanted = bytes.fromhex(frame), bytes.fromhex(parameters)
    assert Parser1().feed(raw) == [Frame1(identifier, instruction, wanted, len(raw))]
    assert encode(identifier, instruction, wanted) == raw


frames = st.builds(encode, st.integers(0, 254), st.integers(0, 255), st.binary(max_size=40))


@given(st.lists(frames, min_size=1, max_size=5), st.data())
def test_frames_in_chunks_of_any_size_come_out_whole(
    sent: list[bytes], data: st.DataObject
) -> None:
    stream, parser, found = b"".join(sent), Parser1(), 0
    while stream:
        size = data.draw(st.integers(1, len(stream)))
        found += sum(isinstance(item, Frame1) for item in parser.feed(stream[:size]))
        stream = stream[size:]
    assert found == len(sent)


@given(st.binary(max_size=60), frames)
def test_behind_any_noise_a_frame_is_found_once_the_noise_has_been_waited_for(
    noise: bytes, frame: bytes
) -> None:
    parser = Parser1()
    parser.feed(noise)
    parser.feed(bytes(300))  # what a frame that began in the noise may swallow
    found = parser.feed(frame)
    assert isinstance(found[-1], Frame1)
    assert encode(*found[-1][:3]) == frame


@given(frames, st.integers(0, 60), st.integers(1, 255))
def test_one_wrong_byte_is_always_noticed(frame: bytes, place: int, change: int) -> None:
    place %= len(frame)
    wrong = frame[:place] + bytes((frame[place] ^ change,)) + frame[place + 1 :]
    intact = [i for i in Parser1().feed(wrong) if isinstance(i, Frame1) and encode(*i[:3]) == frame]
    assert intact == []


def test_what_is_dropped_says_why() -> None:
    frame = encode(3, 2, b"\x24\x02")
    assert Parser1().feed(frame[:-1] + b"\0") == [Frame1Error("checksum", 3, 8)]
    assert Parser1().feed(b"\xff\xff\x03\x01")[0][:2] == ("length", 3)
    assert Parser1(longest=250).feed(encode(254, 0x83, bytes(245)))[0][:2] == ("length", 254)
    assert isinstance(Parser1(longest=250).feed(encode(254, 0x83, bytes(244)))[0], Frame1)


def test_a_third_ff_before_the_id_is_skipped() -> None:
    assert [item[:2] for item in Parser1().feed(b"\xff" + encode(1, 1))] == [(1, 1)]


def test_sealing_makes_any_frame_good() -> None:
    frame = bytearray(encode(1, 0, b"\1\2"))
    frame[2] = 9
    (found,) = Parser1().feed(with_checksum(bytes(frame)))
    assert isinstance(found, Frame1) and found.identifier == 9
