"""Step models that are used again, on a step that is a matrix."""

import numpy as np
import pytest

from windup.control.limit_cycle.step_memory import Frozen, Library, Memory
from windup.control.limit_cycle.step_model import StepModel
from windup.hal.joints import Array, Mask

J = np.array([[0.02, 0.005], [-0.004, 0.03]])


class Steps:
    """A linear step that counts its rollouts; its matrix may change."""

    def __init__(self) -> None:
        self.jacobian, self.offset, self.rollouts = J, np.array([0.1, -0.05]), 0

    def __call__(self, scalings: Array) -> tuple[Array, Mask]:
        self.rollouts += len(scalings)
        return self.offset + scalings @ self.jacobian.T, np.zeros(len(scalings), dtype=bool)


def model(memory: Memory | None) -> StepModel:
    return StepModel(
        "full",
        samples=np.ones(2),
        limits=np.full(2, 30.0),
        weights=np.full(2, 10.0),
        centred=False,
        from_last=True,
        regularisation=1e-9,
        memory=memory,
    )


TARGET = np.array([0.2, 0.1])
HERE = np.zeros(3)


def test_a_frozen_model_needs_one_rollout_and_still_reaches_the_target() -> None:
    steps, frozen = Steps(), model(Frozen(settle=1))
    frozen.control(steps, TARGET, 0, HERE)
    before = steps.rollouts
    found = frozen.control(steps, TARGET, 0, HERE)
    assert steps.rollouts == before + 1
    assert steps(found[None])[0][0] == pytest.approx(TARGET, abs=1e-6)
    assert frozen.counters["reused"] == 1


def test_a_model_that_has_drifted_is_sampled_again() -> None:
    steps, frozen = Steps(), model(Frozen(settle=1))
    frozen.control(steps, TARGET, 0, HERE)
    steps.offset = np.array([0.3, -0.05])
    frozen.control(steps, TARGET, 0, HERE)
    assert frozen.counters["sampled"] == 2 and frozen.counters["reused"] == 0


def test_nothing_is_frozen_before_the_walk_has_settled_nor_on_the_other_side() -> None:
    steps, frozen = Steps(), model(Frozen(settle=3))
    for side in (0, 0, 0, 1):
        frozen.control(steps, TARGET, side, HERE)
    assert frozen.counters["reused"] == 0


def test_a_library_gives_the_nearest_model_within_reach() -> None:
    library = Library(reach=0.05)
    library.store(0, np.array([0.0, 0.0, 0.0]), J)
    library.store(0, np.array([0.1, 0.0, 0.0]), 2.0 * J)
    assert library.recall(0, np.array([0.08, 0.0, 0.0])) == pytest.approx(2.0 * J)
    assert library.recall(0, np.array([0.3, 0.0, 0.0])) is None
    assert library.recall(1, np.zeros(3)) is None


def test_a_library_replaces_what_it_has_learnt_anew_and_stays_small() -> None:
    library = Library(reach=0.05, size=3)
    library.store(0, np.zeros(1), J)
    library.store(0, np.zeros(1), 3.0 * J)
    assert library.recall(0, np.zeros(1)) == pytest.approx(3.0 * J)
    for place in range(9):
        library.store(0, np.array([float(place)]), J)
    assert library.recall(0, np.array([5.0])) is None
