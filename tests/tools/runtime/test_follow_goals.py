import numpy as np
import pytest

from tests.small_world import JOINTS, N, observation
from windup.hal.joints import Array
from windup.tools.runtime.board import LEASE, Board
from windup.tools.runtime.follow_goals import DEADMAN, GoalFollower, largest_speed

DT = 0.01
SPEED = 2.0


class Streamed:
    """A follower, its board, and a clock that is where it was set to."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.time, self.ready = 100.0, True
        monkeypatch.setattr("time.monotonic", lambda: self.time)
        self.board = Board.create(N)
        self.board.words[LEASE] = 1
        self.follower = GoalFollower(
            JOINTS, self.board, np.full(N, SPEED), lambda: self.ready, now=lambda: self.time
        )
        self.follower.reset(observation(position=np.full(N, 0.1)))

    def tick(self, count: int = 1) -> Array:
        for _ in range(count):
            position = self.follower.step(observation(), DT).position
            self.time += DT
        return position

    @property
    def counts(self) -> dict[str, int]:
        return {name: count for name, count in self.board.counts().items() if count}


@pytest.fixture
def streamed(monkeypatch: pytest.MonkeyPatch) -> Streamed:
    return Streamed(monkeypatch)


def test_without_goals_it_holds_the_pose_in_which_it_began(streamed: Streamed) -> None:
    assert streamed.tick(50).tolist() == [0.1] * N
    assert not streamed.follower.streaming and streamed.counts == {}


def test_a_near_goal_is_there_at_the_next_tick(streamed: Streamed) -> None:
    streamed.board.put_goal([0.11] * N)
    assert streamed.tick().tolist() == [0.11] * N
    assert streamed.counts == {}


def test_a_jump_becomes_steps_of_the_largest_speed(streamed: Streamed) -> None:
    streamed.board.put_goal([0.15] * N)
    assert streamed.tick() == pytest.approx(np.full(N, 0.1 + SPEED * DT))
    assert streamed.tick(2) == pytest.approx(np.full(N, 0.15))
    assert streamed.counts == {"stepped": 2}


def test_a_goal_beyond_the_limits_is_clamped_and_counted(streamed: Streamed) -> None:
    streamed.board.put_goal([0.1, 0.1, -0.5, 0.1, 0.1])
    streamed.tick(6)
    assert streamed.follower.position[2] == JOINTS.lower[2]
    assert streamed.counts["limited"] == 1


def test_it_holds_where_it_has_come_to_after_the_deadman_time(streamed: Streamed) -> None:
    streamed.board.put_goal([1.0] * N)
    streamed.tick(round(DEADMAN / DT) + 2)
    held = streamed.tick()
    assert not streamed.follower.streaming and held[0] < 1.0
    assert (streamed.tick(20) == held).all()
    assert streamed.counts["silent"] == 1


def test_goals_go_on_after_a_silence(streamed: Streamed) -> None:
    streamed.board.put_goal([0.11] * N)
    streamed.tick(100)
    streamed.board.put_goal([0.12] * N)
    assert streamed.tick().tolist() == [0.12] * N
    assert streamed.follower.streaming


def test_goals_of_a_client_that_has_left_are_not_followed(streamed: Streamed) -> None:
    streamed.board.put_goal([0.11] * N)
    streamed.board.words[LEASE] = 0
    assert streamed.tick().tolist() == [0.1] * N


def test_a_goal_that_was_given_long_ago_is_not_followed(streamed: Streamed) -> None:
    streamed.board.put_goal([0.11] * N)
    streamed.time += 2 * DEADMAN
    assert streamed.tick().tolist() == [0.1] * N


def test_no_goal_is_followed_before_the_robot_is_ready(streamed: Streamed) -> None:
    streamed.ready = False
    streamed.board.put_goal([0.11] * N)
    assert streamed.tick().tolist() == [0.1] * N
    assert streamed.counts == {"not_ready": 1}


def test_slow_joints_keep_their_own_largest_speed() -> None:
    assert largest_speed(JOINTS).tolist() == [3.0] * N
