import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from windup.hal.protocols import protocol2
from windup.hal.protocols.batched import BlockRead, BlockWrite
from windup.hal.protocols.crc16 import crc16
from windup.hal.protocols.protocol2 import Span

IDS = [1, 2, 5, 9]
EVEN = [Span(id, 126, 10) for id in IDS]
MIXED = [Span(1, 126, 10), Span(2, 126, 21), Span(200, 30, 20)]

tricky = st.lists(st.sampled_from([0, 1, 0xFD, 0xFF, 0xFF, 0x55]), min_size=21, max_size=21)
words = tricky.map(bytes) | st.binary(min_size=21, max_size=21)


def fast_answer(ids: list[int], data: list[bytes]) -> bytes:
    length = 1 + sum(len(value) + 4 for value in data)
    frame = protocol2.HEADER + b"\xfe" + length.to_bytes(2, "little") + b"\x55"
    for id, value in zip(ids, data, strict=True):
        frame += bytes([0, id]) + value
        frame += crc16(frame).to_bytes(2, "little")
    return frame


@given(st.lists(words, min_size=4, max_size=4), st.integers(0, 255))
def test_a_whole_answer_is_taken_apart(data: list[bytes], error: int) -> None:
    for spans in (EVEN, MIXED):
        read = BlockRead(spans)
        parts = [part[: span.size] for span, part in zip(spans, data, strict=False)]
        stream = b"".join(
            protocol2.status(span.id, part, error) for span, part in zip(spans, parts, strict=True)
        )
        assert read.decode(stream).all()
        assert [read.params(row) for row in range(len(spans))] == parts
        assert (read.error == error).all()


@given(st.lists(words, min_size=4, max_size=4))
def test_a_fast_answer_is_taken_apart(data: list[bytes]) -> None:
    parts = [part[:10] for part in data]
    read = BlockRead(EVEN, fast=True)
    stream = fast_answer(IDS, parts)
    assert len(stream) == read.length
    assert read.decode(stream).all()
    assert read.payload.tobytes() == b"".join(parts)


@given(st.lists(words, min_size=4, max_size=4), st.integers(0, 83), st.integers(1, 255))
def test_one_wrong_byte_costs_one_servo(data: list[bytes], place: int, flip: int) -> None:
    read = BlockRead(EVEN)
    frames = [protocol2.status(id, part[:10]) for id, part in zip(IDS, data, strict=True)]
    stream = bytearray(b"".join(frames))
    stream[place % len(stream)] ^= flip
    ends = np.cumsum([len(frame) for frame in frames])
    victim = int(np.searchsorted(ends, place % len(stream), side="right"))
    valid = read.decode(bytes(stream))
    assert [row for row in range(4) if row != victim] == np.flatnonzero(valid).tolist()


def test_wrong_ids_and_sizes_are_skipped() -> None:
    read = BlockRead(EVEN)
    stream = protocol2.status(77, bytes(10)) + protocol2.status(2, bytes(4))
    stream += protocol2.status(9, bytes(range(10)))
    assert read.decode(stream).tolist() == [False, False, False, True]
    assert read.params(3) == bytes(range(10))


def test_a_reply_that_fails_keeps_the_last_good_one() -> None:
    read = BlockRead(EVEN)
    position = read.column(6, "<i4")
    value = (-123).to_bytes(4, "little", signed=True)
    read.decode(b"".join(protocol2.status(id, bytes(6) + value) for id in IDS))
    assert position.tolist() == [-123] * 4
    assert not read.decode(b"").any()
    assert position.tolist() == [-123] * 4


@given(st.lists(st.integers(-(2**31), 2**31 - 1), min_size=4, max_size=4))
def test_a_patched_write_equals_a_built_one(values: list[int]) -> None:
    write = BlockWrite(IDS, 116, 4)
    write.values[:] = values
    data = {
        id: value.to_bytes(4, "little", signed=True) for id, value in zip(IDS, values, strict=True)
    }
    assert write.frame() == protocol2.sync_write(data, 116, 4)


def test_a_goal_with_a_header_in_it_is_stuffed() -> None:
    write = BlockWrite([1], 116, 4)
    write.values[:] = int.from_bytes(b"\xff\xff\xfd\x00", "little")
    assert b"\xff\xff\xfd\xfd\x00" in write.frame()
    write.values[:] = 5
    assert write.frame() == protocol2.sync_write({1: bytes([5, 0, 0, 0])}, 116, 4)
