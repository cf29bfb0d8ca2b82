import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from windup.hal.protocols import protocol1
from windup.hal.protocols.batched1 import GoalWrite, bulk_read, sync_read
from windup.hal.protocols.protocol2 import Span
from windup.hal.servos.feetech_registers import SCS, STS

IDS = [1, 2, 5, 9]
EVEN = [Span(id, 56, 6) for id in IDS]
MIXED = [Span(1, 36, 6), Span(2, 36, 8), Span(7, 43, 1), Span(9, 36, 6)]
tricky = st.lists(st.sampled_from([0, 1, 8, 0xFE, 0xFF]), min_size=8, max_size=8)
words = tricky.map(bytes) | st.binary(min_size=8, max_size=8)


@given(st.lists(words, min_size=4, max_size=4), st.integers(0, 127))
def test_a_whole_answer_is_taken_apart(data: list[bytes], error: int) -> None:
    for read in (sync_read(EVEN), bulk_read(MIXED)):
        parts = [part[: span.size] for span, part in zip(read.spans, data, strict=True)]
        stream = b"".join(
            protocol1.status(span.id, part, error)
            for span, part in zip(read.spans, parts, strict=True)
        )
        assert len(stream) == read.length
        assert read.decode(stream).all() and read.complete
        assert [read.params(row) for row in range(4)] == parts
        assert (read.error == error).all()


@given(st.lists(words, min_size=4, max_size=4), st.integers(0, 47), st.integers(1, 255))
def test_one_wrong_byte_costs_one_servo(data: list[bytes], place: int, flip: int) -> None:
    # A payload that holds a frame of the same servo would take its place; none does here.
    calm = [part[:6].replace(b"\xff", b"\xfd") for part in data]
    read = sync_read(EVEN)
    frames = [protocol1.status(id, part) for id, part in zip(IDS, calm, strict=True)]
    stream = bytearray(b"".join(frames))
    stream[place] ^= flip
    valid = read.decode(bytes(stream))
    assert [row for row in range(4) if row != place // 12] == np.flatnonzero(valid).tolist()


def test_a_reply_that_fails_keeps_the_last_good_one() -> None:
    read = sync_read(EVEN)
    position = read.column(0, "<u2")
    read.decode(b"".join(protocol1.status(id, b"\x00\x08" + bytes(4)) for id in IDS))
    assert position.tolist() == [2048] * 4
    assert not read.decode(b"").any()
    assert position.tolist() == [2048] * 4


@given(st.lists(st.integers(-32767, 32767), min_size=4, max_size=4))
def test_a_patched_write_equals_a_built_one(values: list[int]) -> None:
    register = STS["goal_position"]
    write = GoalWrite(IDS, register, 250)
    write.values[:] = values
    data = {id: register.encode(value) for id, value in zip(IDS, values, strict=True)}
    assert write.frames() == [protocol1.sync_write(data, 42, 2)]


@given(st.lists(st.integers(0, 1023), min_size=90, max_size=90))
def test_a_long_write_is_split_and_big_endian_where_the_register_is(values: list[int]) -> None:
    register = SCS["goal_position"]
    ids = list(range(90))
    write = GoalWrite(ids, register, 250)
    write.values[:] = values
    data = {id: value.to_bytes(2, "big") for id, value in zip(ids, values, strict=True)}
    assert write.frames() == protocol1.split_sync_write(data, 42, 2, 250)
    assert len(write.frames()) == 2
