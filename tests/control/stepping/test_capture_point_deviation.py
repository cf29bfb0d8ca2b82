"""How far a point is off its usual way."""

import numpy as np
import pytest

from windup.control.stepping.capture_point_deviation import DRIFT, LEARN, CapturePointDeviation
from windup.control.stepping.stepping_file import CatchTable

WAY = [np.array([0.01 * tick, 0.02]) for tick in range(5)]


def walked(steps: int) -> CapturePointDeviation:
    throw = CapturePointDeviation()
    for _ in range(steps):
        for tick, point in enumerate(WAY):
            assert not throw.detect(0, tick, point).any()
    return throw


def test_what_has_been_seen_often_enough_is_judged() -> None:
    away = np.array([-0.05, 0.01])
    for steps, judged in ((LEARN - 1, False), (LEARN, True)):
        throw = walked(steps)
        throw.detect(0, 0, WAY[0])
        assert throw.detect(0, 1, WAY[1] + away) == pytest.approx(away if judged else np.zeros(2))


def test_a_state_nobody_knows_and_one_that_lasts_longer_are_not_judged() -> None:
    throw = walked(LEARN + 1)
    far = np.array([9.0, 9.0])
    assert not throw.detect(1, 0, far).any()
    assert not throw.detect(0, len(WAY), far).any()


def test_a_push_hardly_makes_the_next_one_look_usual_but_a_lasting_change_does() -> None:
    throw = walked(LEARN + 1)
    away = np.array([-0.1, 0.0])
    throw.detect(0, 0, WAY[0] + away)
    assert throw.detect(0, 0, WAY[0] + away)[0] == pytest.approx(away[0] + DRIFT)
    for _ in range(100):
        throw.detect(0, 0, WAY[0] + away)
    assert np.abs(throw.detect(0, 0, WAY[0] + away)).max() < 1e-3


def test_forgotten_is_forgotten() -> None:
    throw = walked(LEARN + 1)
    throw.reset()
    assert not throw.detect(0, 0, np.array([9.0, 9.0])).any()


@pytest.mark.parametrize(
    ("thrown", "caught"),
    [((-0.04, 0.0), True), ((-0.02, 0.0), False), ((0.2, 0.0), False), ((-0.04, -0.03), False)],
)
def test_steps_catch_what_is_thrown_far_enough_and_straight_enough_back(
    thrown: tuple[float, float], caught: bool
) -> None:
    assert CatchTable(back=0.03, slant=0.6).meets(np.array(thrown)) is caught
