from math import cos, nan

import numpy as np

from windup.robots.fallen import has_fallen
from windup.robots.records import Fall

FALL = Fall(height=0.2, tilt=1.0)


def test_who_is_low_or_tilted_has_fallen() -> None:
    assert not has_fallen(FALL, 0.3, cos(0.9))
    assert has_fallen(FALL, 0.1, cos(0.9))
    assert has_fallen(FALL, 0.3, cos(1.1))


def test_many_are_judged_at_once_and_what_is_no_number_has_fallen() -> None:
    upright = np.array([1.0, cos(1.1), nan])
    assert has_fallen(FALL, np.full(3, 0.3), upright).tolist() == [False, True, True]
