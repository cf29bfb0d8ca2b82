"""What `windup stop` is told about a stop: what was read of the torque, in words."""

import numpy as np

from windup.hal.joints import Joints
from windup.hal.stopping.stop_flag import Outcome
from windup.hal.torque_state import TorqueState


def stop_outcome(state: TorqueState, joints: Joints) -> Outcome:
    """Return the outcome of a stop after which `state` was read back."""
    count = len(joints)
    if state.all_off:
        return Outcome(said=f"torque is off at all {count} joints, read back")
    if state.all_on:
        names = tuple(joints.names)
        return Outcome(
            said=f"it holds its pose: torque is on at all {count} joints", still_on=names
        )
    parts = []
    if state.on.any():
        parts.append(f"torque is still on at {state.names(joints, state.on)}")
    if state.unknown.any():
        parts.append(f"torque is unknown at {state.names(joints, state.unknown)}: no answer")
    on, unknown = (
        tuple(joints.names[joint] for joint in np.flatnonzero(which))
        for which in (state.on, state.unknown)
    )
    said = f"{'; '.join(parts)}; cut the servo power"
    return Outcome(said=said, stopped=False, still_on=on, unknown=unknown)
