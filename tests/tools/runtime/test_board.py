import numpy as np
import pytest

from windup.hal.errors import UsageError
from windup.tools.runtime.board import LEASE, MOST_JOINTS, Board
from windup.tools.runtime.counts import Count


@pytest.fixture
def board() -> Board:
    return Board.create(3)


def test_the_newest_goal_wins_and_is_read_once(board: Board) -> None:
    board.words[LEASE] = 7
    board.put_goal([0.1, 0.2, 0.3])
    board.put_goal([0.4, 0.5, 0.6])
    goal = board.goal(0)
    assert goal is not None and (goal.number, goal.owner) == (2, 7)
    assert np.frombuffer(goal.position).tolist() == [0.4, 0.5, 0.6]
    assert board.goal(goal.number) is None
    assert board.counts()["replaced"] == 1


def test_a_goal_that_was_read_is_not_counted_as_replaced(board: Board) -> None:
    board.put_goal([0.0, 0.0, 0.0])
    assert board.goal(0) is not None
    board.put_goal([1.0, 0.0, 0.0])
    assert board.counts()["replaced"] == 0


def test_a_goal_that_is_being_written_is_not_read(board: Board) -> None:
    board.put_goal([0.1, 0.2, 0.3])
    board.put_goal([0.4, 0.5, 0.6])
    board._map[1024 + 28] ^= 1
    assert board.goal(0) is None


def test_a_child_sees_the_same_board(board: Board) -> None:
    other = Board.open(board.descriptor)
    board.count(Count.STEPPED)
    assert other.counts()["stepped"] == 1


def test_other_memory_is_no_board(board: Board) -> None:
    board.words[0] = 0
    with pytest.raises(ValueError, match="no board of this version"):
        Board.open(board.descriptor)


def test_too_many_joints_are_refused() -> None:
    with pytest.raises(UsageError, match=f"at most {MOST_JOINTS} joints"):
        Board.create(MOST_JOINTS + 1)


def test_texts_come_in_order_and_none_is_lost(board: Board) -> None:
    texts = [b"%d" % number for number in range(20)]
    taken = []
    for text in texts:
        assert board.orders.put(text) and board.orders.waiting
        taken.append(board.orders.take())
    assert taken == texts and board.orders.take() is None


def test_a_queue_that_nobody_reads_takes_no_more(board: Board) -> None:
    assert [board.orders.put(b"x") for _ in range(9)] == [True] * 8 + [False]
    assert board.orders.take() == b"x" and board.orders.put(b"y")


def test_a_text_that_is_too_long_is_refused(board: Board) -> None:
    assert not board.orders.put(bytes(board.orders.room + 1))
    assert board.orders.put(bytes(board.orders.room)) and board.orders.take() is not None


def test_a_text_that_is_being_written_waits(board: Board) -> None:
    board.orders.put(b"whole")
    board._map[4096 + 8] ^= 1
    assert board.orders.take() is None and board.orders.waiting
