"""Views of MuJoCo's data of one robot, kept because looking one up takes as long as copying it."""

import mujoco

from windup.hal.geometry.up_axis import UP_AXIS
from windup.hal.joints import Array


class BodyViews:
    """Live views of what MuJoCo computes for a robot with a free base; not to be changed.

    Args:
        model: The robot alone: a free joint, then n hinges in MJCF order.
        base: Index of the body with the free joint.
        torso: Index of the body whose z axis is the up vector.

    Attributes:
        data: MuJoCo's data.
        qpos: (7 + n,) position, orientation wxyz of the base, joint positions.
        qvel: (6 + n,) linear velocity of the base, its angular velocity in its frame, joints.
        position: (3,) position of the base, m.
        axes: (3, 3) rotation matrix of the base.
        body_position: (bodies, 3) positions of all bodies, m.
        body_axes: (bodies, 9) their rotation matrices, row by row.
        up: (3,) unit vector along the torso.
        site_position: (sites, 3) positions of all sites, m.
        site_axes: (sites, 9) their rotation matrices, row by row.
        com: (3,) centre of mass, m.
        com_velocity: (3,) its velocity, m/s.
        angular: (3,) angular momentum about it, kg m2/s.
    """

    def __init__(self, model: mujoco.MjModel, base: int, torso: int) -> None:
        self.data = data = mujoco.MjData(model)
        self.qpos: Array = data.qpos
        self.qvel: Array = data.qvel
        self.body_position: Array = data.xpos
        self.body_axes: Array = data.xmat
        self.position: Array = self.body_position[base]
        self.axes: Array = self.body_axes[base].reshape(3, 3)
        self.up: Array = self.body_axes[torso, UP_AXIS]
        self.site_position: Array = data.site_xpos
        self.site_axes: Array = data.site_xmat
        self.com: Array = data.subtree_com[base]
        self.com_velocity: Array = data.subtree_linvel[base]
        self.angular: Array = data.subtree_angmom[base]
