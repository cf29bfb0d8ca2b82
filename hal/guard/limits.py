"""Limits of commands, maximum age of states, and the stop policies."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from windup.hal.joints import Array, Joints

StopPolicy = Literal["hold", "crouch", "limp"]
"""What a stop does: hold the present pose, crouch and switch torque off, or switch it off."""


@dataclass(frozen=True)
class SafetyLimits:
    """Limits of commands, and maximum age of joint states.

    Attributes:
        lower: (5, n) smallest values of the rows of a `JointCommand`.
        upper: (5, n) largest values of the same rows.
        max_age: Maximum age of a joint's state before the guard stops the run, s.
    """

    lower: Array
    upper: Array
    max_age: float = 0.25

    @classmethod
    def of(cls, joints: Joints, max_age: float = 0.25) -> "SafetyLimits":
        """Return the limits of the joints; gains may be up to four times their defaults."""
        zero = np.zeros(len(joints))
        lower = np.stack([joints.lower, -joints.velocity, -joints.torque, zero, zero])
        upper = np.stack(
            [
                joints.upper,
                joints.velocity,
                joints.torque,
                4.0 * joints.stiffness,
                4.0 * joints.damping,
            ]
        )
        return cls(lower, upper, max_age)
