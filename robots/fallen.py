"""What "fallen" means, for a robot, its twin and a batch of rollouts alike."""

from typing import Any

import numpy as np

from windup.robots.records import Fall


def has_fallen(fall: Fall, height: Any, upright: Any) -> Any:
    """Return whether a robot counts as fallen, or each (m,) of many.

    What is not a number has fallen, too.

    Args:
        fall: When it does.
        height: Of its base above the ground, m.
        upright: Vertical component of its torso's z axis: the cosine of its tilt.
    """
    return (height < fall.height) | np.logical_not(upright > np.cos(fall.tilt))
