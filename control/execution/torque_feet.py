"""The two feet (or hands) of a robot with torque joints, by its equation of motion."""

from collections.abc import Sequence

import mujoco
import numpy as np

from windup.control.execution.motion import Planted
from windup.control.kinematics.limb_ik import Pose
from windup.control.kinematics.momenta import Momenta
from windup.control.kinematics.rotation import yaw_of
from windup.control.kinematics.support import SupportRegion
from windup.control.whole_body.dynamics import Dynamics
from windup.hal.joints import Array
from windup.hal.observation import Observation


class TorqueFeet:
    """Measured feet and base; see `windup.control.execution.executor.Feet`.

    Args:
        dynamics: The robot's equation of motion.
        stance: (n,) rad, joint positions of the pose to stand in, base level and soles flat.
        touch: Maximum height of the lowest corner of a foot on the ground, m.

    Attributes:
        dynamics: The equation of motion.
        homes: Positions (3,) of the soles' sites in the stance, relative to the base, m.
        height: Height of the centre of mass above the soles in the stance, m.
        rounded: Support regions are circles and capsules instead of hulls.
    """

    def __init__(self, dynamics: Dynamics, stance: Array, touch: float) -> None:
        self.dynamics, self._touch = dynamics, touch
        self.rounded = False
        model, state = dynamics.model, dynamics.state
        data = mujoco.MjData(model)
        data.qpos[:7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
        data.qpos[7:] = stance
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        self.homes = list(data.site_xpos[state.sites])
        lowest = [
            home[2] + (corners @ data.site_xmat[site].reshape(3, 3).T)[:, 2].min()
            for home, corners, site in zip(self.homes, dynamics.corners, state.sites, strict=True)
        ]
        self.height = float(data.subtree_com[state.base_body, 2] - min(lowest))

    def update(self, observation: Observation) -> None:
        """Measure the feet.

        Raises:
            StateMissingError: The observation has no base.
        """
        self.dynamics.update(observation)

    @property
    def momenta(self) -> Momenta:
        """Momenta of the whole body."""
        return self.dynamics.momenta

    @property
    def yaw(self) -> float:
        """Heading of the base, rad."""
        return yaw_of(self.dynamics.base.rotation)

    @property
    def feet(self) -> list[Pose]:
        """Poses of the soles' sites."""
        return self.dynamics.ends

    @property
    def places(self) -> Array:
        """(2, 2) horizontal positions of these sites, m."""
        return self.dynamics.state.feet_position[:, :2]

    @property
    def down(self) -> list[bool]:
        """For each foot, whether its lowest corner is on the ground."""
        return [float(self.ground(foot)[:, 2].min()) < self._touch for foot in (0, 1)]

    def reach_yaw(self, stance: int) -> float:
        """Return the heading, rad, of a foot's reach: the stance foot's, as the trunk turns."""
        return yaw_of(self.feet[stance].rotation)

    def ground(self, foot: int) -> Array:
        """Return the corners (p, 3) of a sole in the world frame, m."""
        return self.dynamics.ground(foot)

    def middle(self, foot: int) -> Array:
        """Return the middle (2,) of a sole on the ground, m."""
        return self.dynamics.middle(foot)

    def support(self, feet: Sequence[int]) -> SupportRegion:
        """Return the support region of these feet's soles, whether or not they bear load."""
        soles = [self.ground(foot) for foot in feet]
        return (
            SupportRegion.rounded(soles) if self.rounded else SupportRegion.hull(np.vstack(soles))
        )

    def planted(self) -> Planted:
        """Return the measured places of the feet."""
        places = np.zeros((len(self.feet), 3))
        places[:, :2] = self.places
        return Planted(places, np.array([yaw_of(foot.rotation) for foot in self.feet]))
