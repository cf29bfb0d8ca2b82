"""Finds the degree of freedom that first exceeds plausible speeds when a twin diverges."""

import mujoco
import numpy as np

from windup.hal.joints import Array

WILD = 1e5
"""Sum of squared speeds of joints and base above which the simulation is suspect."""


def fastest_dof(model: mujoco.MjModel, data: mujoco.MjData, before: Array, steps: int) -> int:
    """Return the degree of freedom that first got too fast in the last `steps`, by replaying them.

    Args:
        model: The twin's model.
        data: Its state after the steps.
        before: (nq + nv,) positions and velocities before the steps.
        steps: Number of steps.
    """
    replay = mujoco.MjData(model)
    replay.qpos[:], replay.qvel[:] = before[: model.nq], before[model.nq :]
    replay.ctrl[:] = data.ctrl
    replay.history[:] = data.history
    fastest = 0
    for _ in range(steps):
        mujoco.mj_step(model, replay)
        if not np.isfinite(replay.qvel).all():
            break
        fastest = int(np.argmax(np.abs(replay.qvel)))
        if replay.qvel.dot(replay.qvel) > WILD:
            break
    return fastest
