from typing import Any

import numpy as np
import pytest

from tests.tools.runtime.scripted import Script, Scripted
from windup.hal.publishing.run_state import RunState
from windup.tools.remote.messages import Change, End, Ended, Refused
from windup.tools.robot.robot import Robot
from windup.tools.runtime.board import LEASE

DOWN = {RunState.LIMP, RunState.FALLEN, RunState.FAULTED, RunState.STOPPING}


@pytest.fixture
def up() -> Scripted:
    return Scripted(Robot.open("op3"))


def ended(up: Scripted) -> list[bool]:
    return [isinstance(said, Ended) and said.good for said in up.answers]


def test_every_behaviour_can_follow_every_other_without_a_drop_of_torque(up: Scripted) -> None:
    def script() -> Script:
        yield up.run("walk", steps=3)
        yield up.run("stride", seconds=2.0)
        yield up.run("play", graph="wave", seconds=0.3)
        yield up.run("step", foot="left", to=(0.03, 0.085))
        yield up.run("walk", steps=2)
        yield up.run("stand", seconds=0.3)

    up.serve(script())
    assert ended(up) == [True] * 6, [getattr(said, "reason", said) for said in up.answers]
    assert not DOWN & set(up.states)
    assert {RunState.WALKING, RunState.STEPPING, RunState.HOLDING} <= set(up.states)
    assert not up.robot.fallen


def test_a_walk_comes_to_rest_before_it_is_ended(up: Scripted) -> None:
    def script() -> Script:
        up.run("walk", steps=1000, speed=0.1)
        yield lambda: up.robot.session.loop.ticks > 200 and up.state is RunState.WALKING
        up.order(Change(speed=0.2, turn=0.1, style={"nothing": 1.0}))
        up.order(Change(speed=0.2))
        yield lambda: up.robot.session.loop.ticks > 400
        up.order(End())
        yield lambda: up.state is RunState.HOLDING and len(up.answers) == 2
        yield lambda: up.robot.session.loop.ticks > 100

    up.serve(script())
    refused, last = up.answers
    assert isinstance(refused, Refused) and "style of gait 'walk'" in refused.message
    assert isinstance(last, Ended) and last.reason == "ended by its client"
    assert not up.robot.fallen and not DOWN & set(up.states)


def test_a_behaviour_ends_when_its_client_leaves(up: Scripted) -> None:
    def script() -> Script:
        up.run("stand", seconds=1000.0)
        yield lambda: up.state is RunState.STANDING
        up.board.words[LEASE] = 0
        yield lambda: up.state is RunState.HOLDING

    up.serve(script())
    (last,) = up.answers
    assert isinstance(last, Ended) and last.reason == "ended because its client has gone"


def test_goals_are_followed_while_it_holds(up: Scripted) -> None:
    goal = up.robot.description.stance + 0.02

    def script() -> Script:
        up.board.words[LEASE] = 1
        up.board.put_goal(goal.tolist())
        yield lambda: up.robot.session.loop.ticks > 10

    up.serve(script())
    last = up.robot.backend.last
    assert last is not None
    np.testing.assert_allclose(last[1].position, goal, atol=1e-3)  # as a servo takes it
    assert up.states == [RunState.HOLDING]


@pytest.mark.parametrize(
    ("behaviour", "options", "why"),
    [
        ("leap", {}, "unknown behaviour 'leap'"),
        ("walk", {"speeed": 1.0}, "unknown option 'speeed'"),
        ("walk", {"speed": 0.9}, "is outside the range of gait"),
        ("walk", {"delay": 0.008}, "--delay cannot be changed on a robot that is up"),
        ("play", {"graph": "nothing"}, "nothing"),
    ],
)
def test_what_cannot_be_is_refused_and_the_robot_goes_on_holding(
    up: Scripted, behaviour: str, options: dict[str, Any], why: str
) -> None:
    def script() -> Script:
        yield up.run(behaviour, **options)

    up.serve(script())
    (refused,) = up.answers
    assert isinstance(refused, Refused) and why in refused.message
    assert (refused.id, refused.exit_status) == (1, 2)
    assert up.states == [RunState.HOLDING]


def test_a_fall_leaves_it_limp_until_it_may_rise(up: Scripted) -> None:
    def script() -> Script:
        up.run("stand", seconds=1000.0)
        yield lambda: up.state is RunState.STANDING
        up.robot.push(12.0)
        yield lambda: up.state is RunState.FALLEN and len(up.answers) == 1
        yield up.run("stand", seconds=0.1)
        yield up.run("rise", arm=True)

    up.serve(script())
    fell, refused, rose = up.answers
    assert isinstance(fell, Ended) and fell.reason == "fell"
    assert isinstance(refused, Refused) and "has fallen; give --arm" in refused.message
    assert isinstance(rose, Ended) and rose.good, rose
    assert up.states[-1] is RunState.HOLDING and RunState.RISING in up.states


def test_after_a_stop_torque_stays_off_until_it_is_asked_for(up: Scripted) -> None:
    def script() -> Script:
        up.run("stand", seconds=1000.0)
        yield lambda: up.state is RunState.STANDING
        up.run("stand", arm=True, seconds=0.1)  # from before the stop
        up.robot.session.running.end("a test")
        yield lambda: up.state in (RunState.LIMP, RunState.FALLEN)
        yield up.run("stand", seconds=0.1)
        yield up.run("play", arm=True, graph="wave", seconds=0.1)

    up.serve(script())
    stopped, dropped, refused, armed = up.answers
    assert isinstance(stopped, Ended) and stopped.reason == "stopped by a test"
    for said in (dropped, refused):
        assert isinstance(said, Refused)
        assert said.message == "op3 was stopped by a test; give --arm to switch its torque on again"
    assert isinstance(armed, Ended)
