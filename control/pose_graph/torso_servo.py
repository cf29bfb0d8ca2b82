"""The torso servo: one joint that keeps the torso at an angle to the vertical.

Laszlo 1996, section 3.8: ``tau = kp (phi - phi_d) - kd dphi`` on the waist, with the angle of the
torso in the world instead of the joint's own. A position servo does this with a shifted goal.
"""

from dataclasses import dataclass
from math import radians

import numpy as np

from windup.control.pose_graph.gait_file import TorsoServo as TorsoServoRecord
from windup.hal.controller import PolicyInput
from windup.hal.errors import UsageError
from windup.hal.joints import Array, Joints


@dataclass(frozen=True)
class TorsoServo:
    """Shifts the goal of one pitch joint below the torso.

    The torso's pitch is the base's pitch plus the joint's angle, so the joint must be the only
    pitch joint between base and torso, and its axis must point to the left.

    Attributes:
        joint: Index of the joint.
        angle: Desired forward lean of the torso, rad.
        ratio: Damping divided by stiffness of the joint, s.
    """

    joint: int
    angle: float
    ratio: float

    @classmethod
    def of(cls, record: TorsoServoRecord, joints: Joints) -> "TorsoServo":
        """Return the torso servo of a gait file.

        Raises:
            UsageError: Its joint has no stiffness, so that goals have no effect on it.
        """
        j = joints.index(record.joint)
        if not joints.stiffness[j] > 0.0:
            raise UsageError(
                f"joint {record.joint!r} has no stiffness and cannot keep the torso upright; "
                "give it some in robot.toml, or walk with --no-torso-servo"
            )
        return cls(j, radians(record.angle), float(joints.damping[j] / joints.stiffness[j]))

    def apply(self, pose: Array, state: PolicyInput) -> Array:
        """Return targets (m, n) rad with the goal of the servo's joint replaced.

        From ``kp (goal - q) - kd dq = kp (phi_d - phi) - kd dphi``, with phi = pitch + q the
        torso's lean: ``goal = phi_d - pitch - (kd / kp) dpitch``.
        """
        w, x, y, z = state.base_orientation.T
        # Lean of the base about its own y axis, independent of its heading.
        pitch = np.arctan2(2.0 * (w * y - x * z), 1.0 - 2.0 * (x * x + y * y))
        goals = pose.copy()
        goals[:, self.joint] = self.angle - pitch - self.ratio * state.base_angular_velocity[:, 1]
        return goals
