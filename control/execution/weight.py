"""Joint torques that balance gravity while the feet bear given shares of the weight."""

from collections.abc import Sequence

from windup.control.kinematics.robot_state import RobotState
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array


def holding_torque(state: RobotState, shares: Sequence[float]) -> Array:
    """Return the torques (n,) N m that hold the body still in its present state.

    From the principle of virtual work: ``tau = m g (J_com - sum of w_k J_k)``, with the vertical
    rows of the Jacobians of the centre of mass and of the soles' centres.

    Args:
        state: The robot's state.
        shares: w_k, share of the weight that each sole bears; they sum to 1.
    """
    row = state.com_jacobian[2].copy()
    for foot, share in enumerate(shares):
        row -= share * state.jacobian(foot)[2]
    return state.mass * GRAVITY * row[6:]
