"""Joint torques that balance gravity while the feet bear given shares of the weight."""

from collections.abc import Sequence

import mujoco
import numpy as np

from windup.control.kinematics.body import Body
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array


def holding_torque(body: Body, base: str, shares: Sequence[float]) -> Array:
    """Return the torques (n,) N m that hold the body still in its last measured state.

    From the principle of virtual work: ``tau = m g (J_com - sum of w_k J_k)``, with the vertical
    rows of the Jacobians of the centre of mass and of the soles' centres.

    Args:
        body: The robot's kinematics, measured in this tick.
        base: Name of the body with the free joint.
        shares: w_k, share of the weight that each sole bears; they sum to 1.
    """
    model, data = body.model, body.data
    whole = np.zeros((3, model.nv))
    mujoco.mj_jacSubtreeCom(model, data, whole, model.body(base).id)
    row = whole[2].copy()
    for site, share in zip(body.soles, shares, strict=True):
        mujoco.mj_jacSite(model, data, whole, None, int(site))
        row -= share * whole[2]
    return body.mass * GRAVITY * row[6:]
