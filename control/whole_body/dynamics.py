"""Equation of motion of an observed robot, with the kinematics of its ends (feet or hands)."""

from collections.abc import Sequence

import mujoco
import numpy as np

from windup.control.kinematics.limb_ik import Pose
from windup.control.kinematics.momenta import Momenta
from windup.hal.errors import StateMissingError, UsageError
from windup.hal.joints import Array
from windup.hal.observation import Observation


class Dynamics:
    """Computes the terms of M qdd + h = S^T tau + J^T f, with v = 6 + n degrees of freedom.

    Args:
        model: The robot alone: a free joint, then n hinges in MJCF order.
        base: Name of the body with the free joint.
        ends: Names of the sites at the ends that can stand, feet or hands.
        delay: Latency from a measured state to the effect of its command, s; positions are
            extrapolated by it at constant velocity.

    Attributes:
        mass: (v, v) mass matrix M, kg and kg m2.
        bias: (v,) gravity, Coriolis and centrifugal forces h, N and N m.
        momenta: Momenta of the whole body.
        position: (n,) joint positions, rad.
        velocity: (v,) base linear (world frame), base angular (base frame), and joint velocities.
        base: Pose of the base.
        ends: Poses of the ends.
        corners: For each end the points (p, 3) that can touch the ground, in the end's frame, m.
    """

    momenta: Momenta
    position: Array
    base: Pose
    ends: list[Pose]

    def __init__(
        self, model: mujoco.MjModel, base: str, ends: Sequence[str], delay: float = 0.0
    ) -> None:
        self.model, self._data, self._delay = model, mujoco.MjData(model), delay
        self._base = model.body(base).id
        self._sites = [model.site(name).id for name in ends]
        self._total = float(model.body_subtreemass[self._base])
        self.mass = np.zeros((model.nv, model.nv))
        self.bias = np.zeros(model.nv)
        self.velocity = np.zeros(model.nv)
        mujoco.mj_kinematics(model, self._data)
        self._jacobians: list[Array | None] = []
        self._grounds: list[Array] = []
        self.corners = [self._find_corners(site) for site in self._sites]

    def update(self, observation: Observation) -> None:
        """Update all attributes for an observation.

        Raises:
            StateMissingError: The observation has no base.
        """
        state = observation.base
        if state is None:
            raise StateMissingError("the base state is missing; run with `--state true`")
        model, data = self.model, self._data
        self.velocity[:3], self.velocity[3:6] = state.linear_velocity, state.angular_velocity
        self.velocity[6:] = observation.joints.velocity
        data.qpos[:3], data.qpos[3:7] = state.position, state.orientation
        data.qpos[7:], data.qvel[:] = observation.joints.position, self.velocity
        mujoco.mj_integratePos(model, data.qpos, self.velocity, self._delay)
        self.position = data.qpos[7:].copy()
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_makeM(model, data)
        mujoco.mj_fullM(model, data, self.mass)
        mujoco.mj_comVel(model, data)
        mujoco.mj_rne(model, data, 0, self.bias)
        mujoco.mj_subtreeVel(model, data)
        base = self._base
        self.momenta = Momenta.of(data, base, self._total)
        self.base = Pose(data.qpos[:3].copy(), data.xmat[base].reshape(3, 3).copy())
        self.ends = [
            Pose(data.site_xpos[site].copy(), data.site_xmat[site].reshape(3, 3).copy())
            for site in self._sites
        ]
        self._jacobians = [None for _ in self.ends]
        self._grounds = [
            pose.position + corners @ pose.rotation.T
            for pose, corners in zip(self.ends, self.corners, strict=True)
        ]

    def ground(self, end: int) -> Array:
        """Return the corners (p, 3) of an end in the world frame, m."""
        return self._grounds[end]

    def jacobian(self, end: int) -> Array:
        """Return the Jacobian (6, v) of an end: linear, then angular, in the world frame."""
        if (known := self._jacobians[end]) is None:
            known = self._jacobians[end] = np.zeros((6, self.model.nv))
            mujoco.mj_jacSite(self.model, self._data, known[:3], known[3:], self._sites[end])
        return known

    def drift(self, end: int) -> Array:
        """Return the acceleration (6,) of an end at zero joint acceleration, dJ/dt v."""
        rate = np.zeros((6, self.model.nv))
        site = self._sites[end]
        body = int(self.model.site_bodyid[site])
        point = self._data.site_xpos[site]
        mujoco.mj_jacDot(self.model, self._data, rate[:3], rate[3:], point, body)
        return np.asarray(rate @ self.velocity)

    def _find_corners(self, site: int) -> Array:
        """Return the lowest points of the outermost contact spheres of an end, in its frame, m.

        Raises:
            UsageError: The end's body has no geom that collides with the ground.
        """
        model, data = self.model, self._data
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
