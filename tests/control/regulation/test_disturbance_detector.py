"""What counts as unusual in the middle of a step."""

import numpy as np

from windup.control.regulation.disturbance_detector import DisturbanceDetector

WALK = np.array([0.2, 0.05, 0.0])


def test_a_state_is_looked_at_once() -> None:
    shaken = DisturbanceDetector(0.1)
    assert [shaken.entered(state) for state in (0, 0, 1, 1, 0)] == [True, False, True, False, True]


def test_a_push_is_unusual_and_the_same_walk_on_another_heading_is_not() -> None:
    shaken = DisturbanceDetector(0.1)
    assert not shaken.detect(1, WALK, 0.0)
    assert not shaken.detect(1, np.array([-0.05, 0.2, 0.0]), 0.5 * np.pi)
    assert not shaken.detect(2, 3.0 * WALK, 0.0)
    assert shaken.detect(1, WALK + np.array([0.0, 0.2, 0.0]), 0.0)
