"""Joint torques that hold a robot's weight while its feet bear given shares of it."""

from collections.abc import Sequence

import mujoco
import numpy as np

from windup.control.kinematics.body import Body
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array


def holding_torque(body: Body, base: str, shares: Sequence[float]) -> Array:
    """Return (n,) N m that hold the body still as it was last measured.

    From the principle of virtual work: ``tau = m g (J_com - sum of w_k J_k)``, the vertical rows
    of the Jacobians of the centre of mass and of the soles' centres.

    Args:
        body: Measured just now.
        base: Name of the body with the free joint.
        shares: w_k, what part of the weight each sole bears; they sum to 1.
    """
    model, data = body.model, body.data
    whole = np.zeros((3, model.nv))
    mujoco.mj_jacSubtreeCom(model, data, whole, model.body(base).id)
    row = whole[2].copy()
    for site, share in zip(body.soles, shares, strict=True):
        mujoco.mj_jacSite(model, data, whole, None, int(site))
        row -= share * whole[2]
    return body.mass * GRAVITY * row[6:]
