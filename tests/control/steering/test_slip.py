"""Slippery ground is felt by a stance foot that slides in two steps running."""

import numpy as np
import pytest

from windup.control.pose_graph.gait_file import Slip
from windup.control.steering.slip import SlipControl

LAW = Slip(states=["S2"], style="careful", least=0.02)
BEARS, LANDS = 1, 2


def walked(*slides: float) -> SlipControl:
    slip = SlipControl(LAW, frozenset({BEARS}))
    for step, slide in enumerate(slides):
        foot = np.array([0.5 * step, 0.1, 0.0])
        slip.entered(BEARS, foot)
        slip.entered(LANDS, foot + np.array([0.6 * slide, -0.8 * slide, 0.3]))
    return slip


@pytest.mark.parametrize(
    ("slides", "felt"),
    [((0.03,), False), ((0.03, 0.01, 0.03), False), ((0.01, 0.03, 0.03, 0.0), True)],
)
def test_care_is_called_for_once_two_steps_running_have_slid(
    slides: tuple[float, ...], felt: bool
) -> None:
    slip = walked(*slides)
    assert slip.felt == felt
    assert slip.styles() == ({"careful": 1.0} if felt else {})


def test_a_foot_that_moves_while_it_does_not_bear_the_body_does_not_slide() -> None:
    slip = SlipControl(LAW, frozenset({BEARS}))
    for x in (0.0, 0.5, 1.0, 1.5):
        slip.entered(LANDS, np.array([x, 0.0, 0.0]))
    assert not slip.felt


def test_a_new_walk_begins_on_ground_that_holds() -> None:
    slip = walked(0.03, 0.03)
    slip.reset()
    slip.entered(LANDS, np.zeros(3))
    assert not slip.felt
