"""Which replies are believed after an answer that was late or incomplete."""

import pytest

from windup.hal.protocols import protocol1, protocol2
from windup.hal.protocols.batched import BlockRead
from windup.hal.protocols.batched1 import sync_read
from windup.hal.protocols.cyclic import CyclicRead
from windup.hal.protocols.protocol2 import Span

IDS = [1, 2, 5, 9]
OLD, NEW = b"\x11" * 6, b"\x22" * 6


def reply(read: CyclicRead, id: int, data: bytes) -> bytes:
    newer = isinstance(read, BlockRead)
    return protocol2.status(id, data) if newer else protocol1.status(id, data)


def believed(read: CyclicRead, stream: list[tuple[int, bytes]], owed: set[int]) -> dict[int, bytes]:
    read.owed = dict.fromkeys(owed, 1)
    valid = read.decode(b"".join(reply(read, id, data) for id, data in stream))
    return {id: read.params(row) for row, id in enumerate(IDS) if valid[row]}


@pytest.fixture(params=["protocol 1", "protocol 2"])
def read(request: pytest.FixtureRequest) -> CyclicRead:
    spans = [Span(id, 56, 6) for id in IDS]
    return sync_read(spans) if request.param == "protocol 1" else BlockRead(spans)


def test_what_leads_and_begins_the_order_anew_is_an_earlier_answer(read: CyclicRead) -> None:
    stream = [(5, OLD), (9, OLD), (1, NEW), (2, NEW), (5, NEW), (9, NEW)]
    assert believed(read, stream, {5, 9}) == dict.fromkeys(IDS, NEW)
    assert believed(read, stream[:4], {5, 9}) == {1: NEW, 2: NEW}


def test_where_nothing_is_owed_two_replies_under_one_id_are_believed_by_nobody(
    read: CyclicRead,
) -> None:
    stream = [(1, NEW), (2, NEW), (2, OLD), (9, NEW)]
    assert believed(read, stream, set()) == {1: NEW, 9: NEW}


def test_only_owed_replies_may_all_be_late(read: CyclicRead) -> None:
    assert believed(read, [(5, OLD), (9, OLD)], {2, 5, 9}) == {}
    assert read.doubted == {5, 9}
    assert believed(read, [(2, NEW), (5, NEW)], {5, 9}) == {2: NEW, 5: NEW}


def test_where_fewer_answers_come_than_are_owed_the_last_may_be_late_too(read: CyclicRead) -> None:
    whole = [(id, OLD) for id in IDS]
    read.owed = dict.fromkeys(IDS, 2)
    late = b"".join(reply(read, id, data) for id, data in [(9, OLD), *whole])
    assert not read.decode(late).any()
    newer = b"".join(reply(read, id, NEW) for id in IDS)
    assert read.decode(late + newer).all()
    assert read.params(0) == NEW


def test_a_whole_answer_is_believed_whoever_was_silent_before(read: CyclicRead) -> None:
    assert believed(read, [(id, NEW) for id in IDS], set(IDS)) == dict.fromkeys(IDS, NEW)


def test_a_frame_too_many_leaves_only_what_has_its_turn_for_certain(read: CyclicRead) -> None:
    assert believed(read, [(1, NEW), (9, OLD), (2, NEW), (5, NEW)], set()).keys() == {1}


def test_under_the_id_of_a_silent_neighbour_an_answer_is_out_of_its_turn(read: CyclicRead) -> None:
    assert believed(read, [(1, NEW), (5, OLD), (77, NEW), (9, NEW)], set()).keys() == {1, 9}
    assert believed(read, [(1, NEW), (1, OLD), (5, NEW), (9, NEW)], set()).keys() == {5, 9}
    assert believed(read, [(2, OLD), (88, NEW), (5, NEW), (9, NEW)], set()).keys() == {5, 9}


def test_frames_that_are_missing_cost_nobody_else_the_turn(read: CyclicRead) -> None:
    for silent in IDS:
        stream = [(id, NEW) for id in IDS if id != silent]
        assert believed(read, stream, set()).keys() == {*IDS} - {silent}


def test_a_reply_that_came_twice_counts_once(read: CyclicRead) -> None:
    stream = [(1, NEW), (2, NEW), (2, NEW), (5, NEW), (9, NEW)]
    assert believed(read, stream, set()).keys() == {*IDS}


def test_a_reply_of_another_length_is_not_believed_and_has_had_its_turn() -> None:
    block = BlockRead([Span(id, 56, 6) for id in IDS])
    stream = [(1, NEW), (2, NEW[:5]), (2, OLD), (9, NEW)]
    assert believed(block, stream, set()).keys() == {1, 9}
