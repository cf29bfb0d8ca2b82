"""The criterion for a fall, the same for a robot, its twin and batches of rollouts."""

from typing import Any

import numpy as np

from windup.robots.records import Fall


def has_fallen(fall: Fall, height: Any, upright: Any) -> Any:
    """Return whether a robot has fallen, as a bool or an array (m,) of bools.

    Values that are not a number count as a fall.

    Args:
        fall: Limits of height and tilt.
        height: Height of the base above the ground, m.
        upright: Vertical component of the torso's z axis, the cosine of its tilt.
    """
    return (height < fall.height) | np.logical_not(upright > np.cos(fall.tilt))
