"""Which degree of freedom runs away first where a twin diverges."""

import mujoco
import numpy as np

from windup.hal.joints import Array

WILD = 1e5
"""Squared speeds of all joints and the base above which something is going wrong."""


def fastest_dof(model: mujoco.MjModel, data: mujoco.MjData, before: Array, steps: int) -> int:
    """Return the degree of freedom that first got too fast in the last `steps`, replayed.

    Args:
        model: The twin's model.
        data: Its state after the steps.
        before: (nq + nv,) positions and velocities before them.
        steps: How many.
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
