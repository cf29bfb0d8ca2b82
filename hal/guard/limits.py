"""What a command may ask for, and how old a state may be."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from windup.hal.joints import Array, Joints

StopPolicy = Literal["hold", "crouch", "limp"]
"""What "stop" means: hold the present pose, crouch and switch torque off, or switch it off."""


@dataclass(frozen=True)
class SafetyLimits:
    """What a command may ask for, and how old a state may be.

    Attributes:
        lower: (5, n) smallest values of the rows of a `JointCommand`.
        upper: (5, n) largest values of the same rows.
        max_age: Age of a joint's state above which the guard refuses to go on, s.
    """

    lower: Array
    upper: Array
    max_age: float = 0.25

    @classmethod
    def of(cls, joints: Joints, max_age: float = 0.25) -> "SafetyLimits":
        """Return the limits that the joints themselves state; gains up to four times default."""
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
