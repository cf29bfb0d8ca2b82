"""Interpolation between gaits: a style that turns one into another."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from windup.control.pose_graph.blend import blend_name, with_blend
from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.style import StyleInterval, Styling
from windup.hal.errors import ConfigError
from windup.robots import load_robot
from windup.tools.assembly.gaits import find_gait


@pytest.fixture(scope="module")
def walk() -> Gait:
    return find_gait(load_robot("human"), "walk")


def hasty(walk: Gait) -> Gait:
    """Another gait with the states of the walk."""
    graph = replace(walk.graph, pose=walk.graph.pose + 0.1, hold=walk.graph.hold - 0.1)
    assert walk.file.balance is not None
    balance = msgspec.structs.replace(walk.file.balance, targets={"up.forward": 0.45})
    file = msgspec.structs.replace(walk.file, balance=balance)
    return replace(walk, name="hasty", graph=graph, file=file)


@pytest.mark.parametrize("amount", [0.0, 0.3, 1.0])
def test_a_blend_is_linear_between_two_gaits(walk: Gait, amount: float) -> None:
    other = hasty(walk)
    blend = with_blend(walk, other)
    name = blend_name(other.name)
    styling = Styling(blend, spells=(StyleInterval(name, amount),))
    for step in range(40):
        styling.begin_step(0.2 * step)
    scale = styling.scale()
    pose = blend.graph.pose + np.tensordot(scale, blend.pose_change, axes=1)
    np.testing.assert_allclose(pose, (1 - amount) * walk.graph.pose + amount * other.graph.pose)
    timed = np.isfinite(walk.graph.hold)
    hold = blend.graph.hold + scale @ blend.hold_change
    np.testing.assert_allclose(hold[timed], 0.2 - 0.1 * amount)
    assert styling.targets()["up.forward"] == pytest.approx(0.2 * amount)


def test_a_blend_comes_in_step_by_step_and_leaves_the_gait_as_it_was(walk: Gait) -> None:
    blend = with_blend(walk, hasty(walk))
    styling = Styling(blend, spells=(StyleInterval("blend hasty", 1.0),))
    styling.begin_step(0.0)
    assert 0.0 < styling.scale()[blend.index("blend hasty")] < 0.1
    assert blend.graph is walk.graph
    assert len(walk.perturbations) == len(blend.perturbations) - 1


def test_gaits_of_different_states_cannot_be_blended(walk: Gait) -> None:
    other = find_gait(load_robot("op3"), "walk")
    with pytest.raises(ConfigError, match=r"have different states .* cannot be blended; give both"):
        with_blend(walk, other)
