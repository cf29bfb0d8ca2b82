from dataclasses import replace

import numpy as np
import pytest

from windup.control.pose_graph.pose_graph import FOREVER, PoseGraph, RelativeGraph
from windup.hal.errors import ConfigError, UnknownNameError


def graph(
    successor: list[int], pose: float = 0.0, hold: float = 1.0, names: str = "ABCDEF"
) -> PoseGraph:
    """Return a graph over two joints whose last state waits for a sensor."""
    s = len(successor)
    times = np.full(s, hold)
    times[-1] = FOREVER
    sensors = np.zeros((s, 1), dtype=bool)
    sensors[-1] = True
    return PoseGraph(
        names=tuple(names[:s]),
        pose=np.full((s, 2), pose),
        hold=times,
        sensors=sensors,
        timeout=np.full(s, FOREVER),
        successor=np.array(successor),
        stance=np.zeros(s, dtype=np.intp),
        ends_step=np.zeros(s, dtype=bool),
    )


def test_controlled_is_base_plus_k_times_perturbation() -> None:
    base = graph([1, 2, 0], pose=0.5)
    change = RelativeGraph(np.arange(6.0).reshape(3, 2), np.array([0.1, 0.2, 0.3]))
    controlled = base + 2.0 * change
    np.testing.assert_allclose(controlled.pose, 0.5 + 2.0 * change.pose)
    np.testing.assert_allclose(controlled.hold[:2], [1.2, 1.4])
    assert controlled.hold[2] == FOREVER, "a sensor transition is not perturbed"
    np.testing.assert_array_equal(base.pose, np.full((3, 2), 0.5))


def test_perturbations_add_and_scale_from_either_side() -> None:
    one = RelativeGraph(np.full((3, 2), 1.0), np.full(3, 0.1))
    two = RelativeGraph(np.full((3, 2), 5.0), np.full(3, 0.2))
    both = 2.0 * one + two * 3.0
    np.testing.assert_allclose(both.pose, 17.0)
    np.testing.assert_allclose(both.hold, 0.8)


def test_the_difference_of_two_graphs_leads_from_one_to_the_other() -> None:
    near, far = graph([1, 2, 0], 0.0, 1.0), graph([1, 2, 0], 1.0, 3.0)
    arrived = near + (far - near)
    np.testing.assert_allclose(arrived.pose, far.pose)
    np.testing.assert_array_equal(arrived.hold, far.hold)


@pytest.mark.parametrize(("amount", "pose", "hold"), [(0.0, 0.0, 1.0), (1.0, 1.0, 3.0)])
def test_a_blend_ends_at_its_two_graphs(amount: float, pose: float, hold: float) -> None:
    blend = graph([1, 2, 0], 0.0, 1.0).blend(graph([1, 2, 0], 1.0, 3.0), amount)
    np.testing.assert_allclose(blend.pose, pose)
    np.testing.assert_allclose(blend.hold, [hold, hold, FOREVER])


def test_a_blend_is_linear_between() -> None:
    blend = graph([1, 2, 0], 0.0, 1.0).blend(graph([1, 2, 0], 1.0, 3.0), 0.25)
    np.testing.assert_allclose(blend.pose, 0.25)
    np.testing.assert_allclose(blend.hold[:2], 1.5)


def test_graphs_of_different_states_cannot_be_blended() -> None:
    with pytest.raises(ConfigError) as error:
        graph([1, 2, 0]).blend(graph([1, 2, 2]), 0.5)
    assert str(error.value) == (
        "graph and graph have different states (A, B, C and A, B, C) and cannot be blended; "
        "give both as many, with the same `until`, `stance` and `ends_step`"
    )
    one = graph([1, 2, 0])
    with pytest.raises(ConfigError, match="cannot be blended"):
        one.blend(replace(one, stance=one.stance + 1), 0.5)


def test_states_of_other_names_can_be_blended_where_they_end_alike() -> None:
    blend = graph([1, 2, 0]).blend(graph([1, 2, 0], 1.0, names="XYZ"), 0.5)
    np.testing.assert_allclose(blend.pose, 0.5)


def test_a_perturbation_of_other_states_does_not_fit() -> None:
    with pytest.raises(ConfigError) as error:
        graph([1, 2, 0]) + RelativeGraph(np.zeros((2, 2)), np.zeros(2))
    assert str(error.value) == (
        "graph: a perturbation of 2 states on a graph of 3; both need the same states"
    )


@pytest.mark.parametrize(
    ("successor", "periodic"),
    [([1, 2, 0], True), ([1, 2, 2], False), ([0], False), ([1, 2, 1], True)],
    ids=["ring", "line", "one state", "lead-in and ring"],
)
def test_a_graph_is_periodic_unless_it_comes_to_an_end(
    successor: list[int], periodic: bool
) -> None:
    assert graph(successor).periodic is periodic


def test_states_that_nothing_leads_to_are_named() -> None:
    with pytest.raises(ConfigError) as error:
        graph([2, 0, 0, 3])
    assert str(error.value) == (
        "graph: no state leads to B, D; give the state before it a `next`, or delete it"
    )


def test_a_state_is_found_by_name() -> None:
    ring = graph([1, 2, 0])
    assert (len(ring), ring.index("C")) == (3, 2)
    with pytest.raises(UnknownNameError, match="unknown state 'D'; known: A, B, C"):
        ring.index("D")
