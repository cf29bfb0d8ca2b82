"""Finds the lowest point of a robot that has no feet."""

import mujoco
import numpy as np


def lowest_point(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Return the lowest corner's height of the boxes around all colliding geoms, m; 0 if none.

    Args:
        model: A robot and its floor.
        data: Its state, with up-to-date kinematics.
    """
    solid = (model.geom_contype > 0) | (model.geom_conaffinity > 0)
    geoms = np.flatnonzero(solid & (model.body_weldid[model.geom_bodyid] > 0))
    if not geoms.size:
        return 0.0
    down = data.geom_xmat[geoms].reshape(-1, 3, 3)[:, 2]
    centre, size = model.geom_aabb[geoms, :3], model.geom_aabb[geoms, 3:]
    heights = data.geom_xpos[geoms, 2] + (down * centre).sum(axis=1)
    return float((heights - (np.abs(down) * size).sum(axis=1)).min())
