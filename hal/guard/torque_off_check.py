"""Errors for a stop after which torque is not, or may not be, off."""

from windup.hal.errors import TorqueOnError, TorqueUnknownError
from windup.hal.joints import Joints
from windup.hal.torque_state import TorqueState


def check_torque_off(state: TorqueState, joints: Joints) -> None:
    """Raise unless the torque of all joints was read back as off.

    Raises:
        TorqueOnError: A joint read back as on.
        TorqueUnknownError: A joint could not be read back.
    """
    if state.on.any():
        where = state.names(joints, state.on)
        raise TorqueOnError(f"torque is still on at {where}; cut the servo power")
    if state.unknown.any():
        where = state.names(joints, state.unknown)
        raise TorqueUnknownError(
            f"torque is unknown at {where}: no answer; it may be on: cut the servo power, "
            "or plug the adapter in again"
        )
