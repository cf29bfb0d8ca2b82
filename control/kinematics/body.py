"""Whole-body quantities of an observed robot, computed with its MuJoCo model."""

from collections.abc import Sequence

import mujoco
import numpy as np

from windup.control.kinematics.momenta import Momenta
from windup.hal.controller import Outcomes
from windup.hal.errors import StateMissingError
from windup.hal.geometry.up_axis import UP_AXIS
from windup.hal.joints import Array
from windup.hal.observation import Observation


class Body:
    """Computes centre of mass, feet and torso of a robot with a free base.

    Args:
        model: The robot alone: a free joint, then n hinges in MJCF order.
        base: Name of the body with the free joint.
        torso: Name of the body whose z axis is the up vector.
        soles: Names of the sites at the soles' centres, one per foot.

    Attributes:
        soles: Indices of these sites.
        mass: Mass of the robot, kg.
    """

    def __init__(self, model: mujoco.MjModel, base: str, torso: str, soles: Sequence[str]) -> None:
        self.model, self.data = model, mujoco.MjData(model)
        self._base = model.body(base).id
        self._torso = model.body(torso).id
        self.soles = np.array([model.site(name).id for name in soles], dtype=np.intp)
        self.mass = float(model.body_subtreemass[self._base])

    def measure(self, observation: Observation) -> Outcomes:
        """Return the whole-body state of `observation` as a batch of one.

        Raises:
            StateMissingError: The observation has no base.
        """
        base = observation.base
        if base is None:
            raise StateMissingError("the base state is missing; run with `--state estimated`")
        data = self.data
        data.qpos[:3] = base.position
        data.qpos[3:7] = base.orientation
        data.qpos[7:] = observation.joints.position
        data.qvel[:3] = base.linear_velocity
        data.qvel[3:6] = base.angular_velocity
        data.qvel[6:] = observation.joints.velocity
        mujoco.mj_kinematics(self.model, data)
        mujoco.mj_comPos(self.model, data)
        mujoco.mj_comVel(self.model, data)
        mujoco.mj_subtreeVel(self.model, data)
        return Outcomes(
            duration=np.zeros(1),
            base_position=base.position[None],
            base_orientation=base.orientation[None],
            base_velocity=data.qvel[None, :6].copy(),
            joint_position=observation.joints.position[None],
            com=data.subtree_com[None, self._base].copy(),
            com_velocity=data.subtree_linvel[None, self._base].copy(),
            feet=data.site_xpos[None, self.soles].copy(),
            torso=data.xmat[None, self._torso, UP_AXIS].copy(),
            contacts=observation.contacts[None],
            fell=np.zeros(1, dtype=bool),
        )

    def momenta(self) -> Momenta:
        """Return the momenta of the whole body in the last measured state."""
        return Momenta.of(self.data, self._base, self.mass)


def heading(orientation: Array) -> Array:
    """Return the headings (...,) of a base, rad, from quaternions (..., 4) wxyz.

    The forward direction is orthogonal to the ground-plane projection of the line that joins the
    hips, which is the base's y axis (Laszlo 1996, section 3.5).
    """
    w, x, y, z = np.moveaxis(orientation, -1, 0)
    left_x, left_y = 2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z)
    return np.arctan2(-left_x, left_y)
