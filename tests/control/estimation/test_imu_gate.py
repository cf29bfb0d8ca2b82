from dataclasses import replace

import numpy as np
import pytest

from tests.hal.imu_samples import DT, GRAVITY, UP, seen, still
from windup.control.estimation.imu_gate import ImuGate
from windup.hal.errors import ImuError
from windup.hal.guard.imu_watch import ImuWatch
from windup.hal.observation import BaseState, ImuState, Observation


class Follower:
    """An estimator that notes what it was given."""

    def __init__(self) -> None:
        self.given: list[ImuState] = []
        self.resets = 0

    def reset(self) -> None:
        self.resets += 1

    def update(self, observation: Observation, dt: float) -> Observation:
        assert observation.imu is not None
        self.given.append(observation.imu)
        upright = np.array([1.0, 0.0, 0.0, 0.0])
        base = BaseState(np.zeros(3), upright, np.zeros(3), np.zeros(3), 1.0)
        return replace(observation, base=base)


def gate(needed: bool) -> tuple[ImuGate, Follower]:
    follower = Follower()
    return ImuGate(follower, ImuWatch(), needed, "; look there"), follower


def test_an_imu_that_is_well_passes_as_it_is() -> None:
    guarded, follower = gate(needed=True)
    run = still(1.0)
    for observation in run:
        assert guarded.update(observation, DT).base is not None
    assert follower.given == [observation.imu for observation in run]


def silence(seconds: float) -> list[Observation]:
    return [seen(1.0 + k * DT, age=k * DT) for k in range(round(seconds / DT))]


def test_who_needs_the_imu_is_stopped() -> None:
    guarded, _ = gate(needed=True)
    with pytest.raises(ImuError) as error:
        for observation in [*still(1.0), *silence(1.0)]:
            guarded.update(observation, DT)
    assert str(error.value) == (
        "the IMU is silent for 0.26 s (stop at 0.25 s): check its cable and power; look there"
    )
    assert error.value.exit_status == 3


def test_who_does_not_need_it_goes_on_with_one_that_rests() -> None:
    guarded, follower = gate(needed=False)
    for observation in [*still(1.0), *silence(1.0)]:
        result = guarded.update(observation, DT)
        assert result.imu is observation.imu, "what was measured stays what it was"
    guess = follower.given[-1]
    np.testing.assert_array_equal(guess.angular_velocity, np.zeros(3))
    np.testing.assert_allclose(guess.acceleration, np.array(UP) * GRAVITY, atol=1e-2)
    assert result.base is not None and result.base.confidence == 0.0
    assert follower.resets == 1
    for observation in still(0.5, 2.0):
        result = guarded.update(observation, DT)
    assert result.base is not None and result.base.confidence == 1.0, "it is back"


def test_rates_that_are_doubted_are_replaced_by_the_last_that_were_not() -> None:
    guarded, follower = gate(needed=True)
    for observation in [*still(1.0), seen(1.0, (4.0, 0.0, 0.0))]:
        guarded.update(observation, DT)
    np.testing.assert_array_equal(follower.given[-1].angular_velocity, np.zeros(3))


@pytest.mark.parametrize(
    ("observation", "says"),
    [
        (replace(seen(0.0), imu=None), "the IMU has said nothing yet: nothing has moved; check"),
        (seen(0.0, age=0.4), "the IMU has said nothing for 0.40 s: nothing has moved; check"),
    ],
)
def test_a_silent_imu_is_refused_before_anything_moves(observation: Observation, says: str) -> None:
    guarded, _ = gate(needed=True)
    with pytest.raises(ImuError, match=says):
        guarded.admit(lambda: observation)
    gate(needed=False)[0].admit(lambda: observation)


def test_one_lost_answer_refuses_nobody() -> None:
    answers = iter([seen(0.0, age=0.4), seen(0.01)])
    gate(needed=True)[0].admit(lambda: next(answers))
