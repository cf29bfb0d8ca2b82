from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from windup.control.limit_cycle.step_model import StepModel
from windup.control.pose_graph.gait_file import Sampling
from windup.hal.joints import Array, Mask

NOMINAL = np.array([0.3, -0.2])
TARGET = np.array([0.45, -0.35])
FULL = np.array([[0.05, 0.02], [-0.03, 0.06]])
SHAPES = {
    "sp": np.diag([0.05, -0.04]),
    "fl": np.array([[0.05, 0.0], [0.03, -0.04]]),  # each variable feels what was solved before
    "lf": np.array([[0.05, 0.03], [0.0, -0.04]]),
    "full": FULL,
}


@dataclass
class Plant:
    """Steps whose ends are linear in their scalings, and that fall past a limit."""

    J: Array
    falls_above: float = np.inf
    falls_below: float = -np.inf
    tried: list[Array] = field(default_factory=list)

    def __call__(self, scalings: Array) -> tuple[Array, Mask]:
        self.tried.append(scalings.copy())
        outside = (scalings > self.falls_above) | (scalings < self.falls_below)
        fell = np.asarray(outside.any(axis=1))
        values = self.end(scalings)
        values[fell] = 99.0  # what a fallen robot shows means nothing
        return values, fell

    def end(self, scalings: Array) -> Array:
        return NOMINAL + scalings @ self.J.T


def model(sampling: Sampling, **settings: Any) -> StepModel:
    given_settings = {
        "samples": np.array([2.0, 1.5]),
        "limits": np.full(2, 50.0),
        "weights": np.ones(2),
        "regularisation": 0.0,
    }
    return StepModel(sampling, **{**given_settings, **settings})


@pytest.mark.parametrize("centred", [True, False], ids=["centred", "one-sided"])
@pytest.mark.parametrize("sampling", ["sp", "fl", "lf", "full"])
def test_each_sampling_reaches_the_target_where_its_assumption_holds(
    sampling: Sampling, centred: bool
) -> None:
    plant = Plant(SHAPES[sampling])
    found = model(sampling, centred=centred).control(plant, TARGET, side=0)
    np.testing.assert_allclose(plant.end(found), TARGET, atol=1e-9)


@pytest.mark.parametrize("sampling", ["sp", "fl", "lf"])
def test_one_dimension_at_a_time_misses_where_dimensions_are_coupled(sampling: Sampling) -> None:
    plant = Plant(FULL)
    found = model(sampling).control(plant, TARGET, side=0)
    assert np.abs(plant.end(found) - TARGET).max() > 0.01


@given(
    entries=st.lists(st.floats(-0.1, 0.1), min_size=4, max_size=4),
    target=st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
)
def test_the_full_model_inverts_any_jacobian_that_can_be_inverted(
    entries: list[float], target: tuple[float, float]
) -> None:
    J = np.array(entries).reshape(2, 2) + 0.3 * np.eye(2)
    plant = Plant(J)
    found = model("full", centred=False).control(plant, np.array(target), side=1)
    np.testing.assert_allclose(plant.end(found), target, atol=1e-6)


def test_damping_stops_short_of_the_target_by_no_more_than_it_says() -> None:
    plant = Plant(SHAPES["sp"])
    damped = model("full", regularisation=1e-3).control(plant, TARGET, side=0)
    # Ridge regression of one scaled dimension leaves reg / (reg + slope^2) of the error.
    slopes = np.diag(SHAPES["sp"]) * [2.0, 1.5]
    left = 1e-3 / (1e-3 + slopes**2)
    np.testing.assert_allclose(TARGET - plant.end(damped), left * (TARGET - NOMINAL), rtol=1e-6)


def test_weights_say_which_variable_gives_way() -> None:
    plant = Plant(np.array([[0.05, 0.05], [0.05, 0.05001]]))  # both cannot be had
    first = model("full", weights=np.array([100.0, 1.0]), regularisation=1e-3)
    error = np.abs(plant.end(first.control(plant, TARGET, side=0)) - TARGET)
    assert error[0] < 0.1 * error[1]


@pytest.mark.parametrize(
    ("sampling", "centred", "rollouts"),
    [("sp", True, [4]), ("fl", True, [2, 2]), ("full", False, [3]), ("full", True, [5])],
)
def test_a_step_costs_as_many_rollouts_as_its_sampling_says(
    sampling: Sampling, centred: bool, rollouts: list[int]
) -> None:
    plant = Plant(FULL)
    model(sampling, centred=centred).control(plant, TARGET, side=0)
    assert [len(batch) for batch in plant.tried] == rollouts


def test_the_second_dimension_is_sampled_with_the_scaling_found_for_the_first() -> None:
    for sampling, first in (("fl", 0), ("lf", 1)):
        plant = Plant(SHAPES[sampling])
        found = model(sampling).control(plant, TARGET, side=0)  # type: ignore[arg-type]
        np.testing.assert_allclose(plant.tried[1][:, first], found[first])
        assert not plant.tried[0][:, 1 - first].any()


# Samples that fall


@pytest.mark.parametrize("centred", [True, False], ids=["centred", "one-sided"])
@pytest.mark.parametrize("sampling", ["sp", "fl", "lf", "full"])
def test_a_sample_that_falls_is_tried_on_the_other_side(sampling: Sampling, centred: bool) -> None:
    near = NOMINAL + np.array([0.04, -0.03])  # its own scalings stand
    plant = Plant(SHAPES[sampling], falls_above=1.0)
    subject = model(sampling, centred=centred)
    found = subject.control(plant, near, side=0)
    np.testing.assert_allclose(plant.end(found), near, atol=1e-9)
    assert subject.counters["dropped"] == subject.counters["kept_last"] == 0
    if not (sampling == "full" and centred):  # which has the other side already
        assert subject.counters["retried"] > 0


@pytest.mark.parametrize("sampling", ["sp", "fl", "lf"])
def test_a_dimension_that_falls_on_both_sides_keeps_its_last_scaling(sampling: Sampling) -> None:
    subject = model(sampling)
    last = subject.control(Plant(np.diag([0.05, 0.05])), TARGET, side=0)
    found = subject.control(Plant(np.diag([0.05, 0.05]), 1.0, -1.0), TARGET + 0.1, side=0)
    np.testing.assert_array_equal(found, last)
    assert subject.counters["dropped"] == 2


def test_a_column_that_falls_on_both_sides_comes_from_the_last_good_model() -> None:
    subject = model("full", centred=False)
    subject.control(Plant(FULL), TARGET, side=0)
    plant = Plant(FULL, 1.0, -1.0)
    found = subject.control(plant, TARGET + 0.05, side=0)
    np.testing.assert_allclose(plant.end(found), TARGET + 0.05, atol=1e-9)
    counted = {name: count for name, count in subject.counters.items() if count}
    assert counted == {"retried": 2, "dropped": 2, "sampled": 2}


def test_without_any_good_model_a_fallen_column_is_left_alone() -> None:
    subject = model("full", centred=False, regularisation=1e-9)
    found = subject.control(Plant(FULL, 1.0, -1.0), TARGET, side=0)
    np.testing.assert_array_equal(found, [0.0, 0.0])
    assert subject.counters["dropped"] == 2


def test_an_origin_that_falls_is_left_for_zero() -> None:
    subject = model("full", centred=False, from_last=True, keep=1.0)
    last = subject.control(Plant(FULL), TARGET, side=0)
    assert np.abs(last).max() > 1.0
    plant = Plant(FULL, falls_above=2.5, falls_below=-2.5)
    found = subject.control(plant, TARGET, side=0)
    np.testing.assert_array_equal(plant.tried[1][0], [0.0, 0.0])
    np.testing.assert_allclose(plant.end(found), TARGET, atol=1e-9)
    assert subject.counters["retried"] == 1


def test_when_even_zero_falls_the_last_scalings_are_kept() -> None:
    subject = model("full", centred=False)
    last = subject.control(Plant(FULL), TARGET, side=0)
    found = subject.control(Plant(FULL, falls_above=-1.0), TARGET + 1.0, side=0)
    np.testing.assert_array_equal(found, last)
    assert subject.counters["kept_last"] == 1


@pytest.mark.parametrize("sampling", ["sp", "fl", "lf"])
def test_a_singular_model_keeps_the_last_good_scalings(sampling: Sampling) -> None:
    subject = model(sampling)
    last = subject.control(Plant(SHAPES["sp"]), TARGET, side=0)
    found = subject.control(Plant(np.zeros((2, 2))), TARGET, side=0)
    np.testing.assert_array_equal(found, last)
    assert subject.counters["kept_last"] == 2


@pytest.mark.parametrize("regularisation", [0.0, 1e-3])
def test_a_singular_full_model_keeps_the_last_good_scalings_too(regularisation: float) -> None:
    subject = model("full", centred=False, regularisation=regularisation)
    last = subject.control(Plant(FULL), TARGET, side=0)
    found = subject.control(Plant(np.zeros((2, 2))), TARGET, side=0)
    np.testing.assert_array_equal(found, last)
    assert subject.counters["kept_last"] == 1


# Limits and memory


@pytest.mark.parametrize("sampling", ["sp", "full"])
def test_scalings_are_clipped_to_their_limits_and_counted(sampling: Sampling) -> None:
    subject = model(sampling, limits=np.array([1.0, 2.0]))
    found = subject.control(Plant(SHAPES["sp"]), NOMINAL + 9.0, side=0)
    np.testing.assert_array_equal(found, [1.0, -2.0])
    assert subject.counters["clipped"] == 1
    subject.control(Plant(SHAPES["sp"]), NOMINAL, side=0)
    assert subject.counters["clipped"] == 1


def test_samples_lie_around_the_same_sides_last_scalings() -> None:
    plant = Plant(FULL)
    subject = model("full", from_last=True, keep=0.5, centred=False)
    left = subject.control(plant, TARGET, side=0)
    right = subject.control(plant, TARGET - 0.4, side=1)
    assert not np.allclose(left, right)
    plant.tried.clear()
    subject.control(plant, TARGET, side=0)
    subject.control(plant, TARGET, side=1)
    np.testing.assert_allclose(plant.tried[0][0], 0.5 * left)
    np.testing.assert_allclose(plant.tried[1][0], 0.5 * right)


def test_without_from_last_samples_lie_around_zero() -> None:
    plant = Plant(FULL)
    subject = model("full", from_last=False, centred=False)
    for _ in range(2):
        subject.control(plant, TARGET, side=0)
        np.testing.assert_array_equal(plant.tried[-1][0], [0.0, 0.0])


def test_reset_forgets_all_steps() -> None:
    plant = Plant(FULL)
    subject = model("full", from_last=True, centred=False)
    subject.control(plant, TARGET, side=0)
    subject.reset()
    subject.control(plant, TARGET, side=0)
    np.testing.assert_array_equal(plant.tried[-1][0], [0.0, 0.0])


def test_a_bent_plant_is_reached_by_more_models_and_a_near_one_needs_none() -> None:
    class Bent(Plant):
        def end(self, scalings: Array) -> Array:
            straight: Array = NOMINAL + scalings @ self.J.T
            return straight + 2.0 * (straight - NOMINAL) ** 2

    errors = []
    for rounds in (0, 4):
        plant, found = Bent(FULL), model("full", rounds=rounds, miss=0.01)
        end = plant.end(found.control(plant, NOMINAL + 0.3, side=0)[None])[0]
        errors.append(float(np.abs(end - NOMINAL - 0.3).max()))
        assert bool(found.counters["refined"]) == bool(rounds)
    assert errors[1] < 0.01 < errors[0]
    near = model("full", rounds=4, miss=0.5)
    near.control(Bent(FULL), NOMINAL + 0.1, side=0)
    assert not near.counters["refined"]
