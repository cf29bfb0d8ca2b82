"""Equation of motion of an observed robot, with the kinematics of its ends (feet or hands)."""

import mujoco
import numpy as np

from windup.control.kinematics.limb_ik import Pose
from windup.control.kinematics.momenta import Momenta
from windup.control.kinematics.robot_state import RobotState
from windup.hal.errors import UsageError
from windup.hal.joints import Array
from windup.hal.observation import Observation


class Dynamics:
    """Computes the terms of M qdd + h = S^T tau + J^T f, with v = 6 + n degrees of freedom.

    Args:
        state: The robot, whose sites are the ends that can stand, feet or hands; it may be
            extrapolated by the latency from a measured state to the effect of its command.

    Attributes:
        state: The robot.
        mass: (v, v) mass matrix M, kg and kg m2.
        bias: (v,) gravity, Coriolis and centrifugal forces h, N and N m.
        corners: For each end the points (p, 3) that can touch the ground, in the end's frame, m.
    """

    def __init__(self, state: RobotState) -> None:
        self.state, self.model = state, state.model
        self.mass = np.zeros((self.model.nv, self.model.nv))
        self.bias = np.zeros(self.model.nv)
        self._observation: Observation | None = None
        self._grounds: list[Array] = []
        self._middles: list[Array | None] = []
        data = mujoco.MjData(self.model)
        mujoco.mj_kinematics(self.model, data)
        self.corners = [self._find_corners(data, int(site)) for site in state.sites]

    def update(self, observation: Observation) -> None:
        """Update all attributes for an observation, unless they are of that one already.

        Raises:
            StateMissingError: The observation has no base.
        """
        if observation is self._observation:
            return
        state, model = self.state.update(observation), self.model
        data = state.position_stage.data
        mujoco.mj_makeM(model, data)
        mujoco.mj_fullM(model, data, self.mass)
        mujoco.mj_rne(model, state.velocity_stage.data, 0, self.bias)
        self._grounds = [
            pose.position + corners @ pose.rotation.T
            for pose, corners in zip(state.feet, self.corners, strict=True)
        ]
        self._middles = [None for _ in self._grounds]
        self._observation = observation

    @property
    def momenta(self) -> Momenta:
        """Momenta of the whole body."""
        return self.state.momenta

    @property
    def position(self) -> Array:
        """(n,) joint positions, rad."""
        return self.state.joint_position

    @property
    def velocity(self) -> Array:
        """(v,) base linear (world frame), base angular (base frame), and joint velocities."""
        return self.state.velocity

    @property
    def base(self) -> Pose:
        """Pose of the base."""
        return self.state.pose

    @property
    def ends(self) -> list[Pose]:
        """Poses of the ends."""
        return self.state.feet

    def ground(self, end: int) -> Array:
        """Return the corners (p, 3) of an end in the world frame, m."""
        return self._grounds[end]

    def middle(self, end: int) -> Array:
        """Return the centre (2,) of the corners of an end, on the ground, m."""
        if (known := self._middles[end]) is None:
            corners = self._grounds[end][:, :2]
            known = self._middles[end] = np.add.reduce(corners, axis=0) / len(corners)
        return known

    def jacobian(self, end: int) -> Array:
        """Return the Jacobian (6, v) of an end: linear, then angular, in the world frame."""
        return self.state.jacobian(end)

    def drift(self, end: int) -> Array:
        """Return the acceleration (6,) of an end at zero joint acceleration, dJ/dt v."""
        rate = np.zeros((6, self.model.nv))
        site, data = int(self.state.sites[end]), self.state.velocity_stage.data
        body = int(self.model.site_bodyid[site])
        mujoco.mj_jacDot(self.model, data, rate[:3], rate[3:], data.site_xpos[site], body)
        return np.asarray(rate @ self.velocity)

    def _find_corners(self, data: mujoco.MjData, site: int) -> Array:
        """Return the lowest points of the outermost contact spheres of an end, in its frame, m.

        Raises:
            UsageError: The end's body has no geom that collides with the ground.
        """
        model = self.model
        on = model.geom_bodyid == model.site_bodyid[site]
        geoms = np.flatnonzero(on & (model.geom_conaffinity > 0))
        if not geoms.size:
            raise UsageError(f"site {model.site(site).name!r}: its body has no geom for the ground")
        rotation = data.site_xmat[site].reshape(3, 3)
        points = (data.geom_xpos[geoms] - data.site_xpos[site]) @ rotation
        points[:, 2] -= model.geom_size[geoms, 0]
        return points[_outermost(points)]


def _outermost(points: Array) -> Array:
    """Return the indices of the points (p, 3) extreme in a diagonal direction, at most four."""
    signs = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]])
    centred = points[:, :2] - points[:, :2].mean(axis=0)
    scale = np.maximum(np.abs(centred).max(axis=0), 1e-9)
    return np.unique(np.argmax(signs @ (centred / scale).T, axis=1))
