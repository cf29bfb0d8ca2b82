"""The whole body of an observed robot: poses, momenta and Jacobians, each computed once a tick.

Everybody who controls, supervises or protects a robot reads one `RobotState`. Whoever comes first
in a tick updates it with the observation; for the others that is the same observation, and what has
been computed for it stays. A quantity that nobody asks for is not computed.

The estimator comes before: it makes the base state, from the kinematics relative to the base and
with joint positions at one time (see `Soles`). Its result is another observation than the one that
it was given, so no quantity of the old base remains.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from windup.control.kinematics.body_views import BodyViews
from windup.control.kinematics.computed_once import ComputedOnce, computed_once
from windup.control.kinematics.limb_ik import Pose
from windup.control.kinematics.momenta import Momenta
from windup.control.kinematics.rotation import facing
from windup.control.kinematics.soles import Indices, Soles
from windup.hal.contacts import ContactSensors
from windup.hal.controller import Outcomes
from windup.hal.errors import StateMissingError
from windup.hal.joints import Array
from windup.hal.observation import BaseState, Observation

if TYPE_CHECKING:
    from windup.control.kinematics.support import SupportRegion


class RobotState:
    """State of a robot with a free base, by its MuJoCo model; all vectors in the world frame.

    Its arrays belong to one observation: the next one makes new arrays and changes none.

    Args:
        model: The robot alone: a free joint, then n hinges in MJCF order; v = 6 + n.
        base: Name of the body with the free joint.
        torso: Name of the body whose z axis is the up vector.
        sites: Names of the k sites at the soles' centres, or at the ends of other limbs.
        feet: Names of the feet's bodies, in the same order; needed for the points of the soles.
        contacts: The contact sensors; needed for the points of the soles.
        ahead: Time by which the positions are extrapolated at the observed velocities, s.

    Attributes:
        model: The model.
        base_body: Index of the base.
        sites: (k,) indices of the sites.
        mass: Mass of the robot, kg.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        base: str,
        torso: str,
        sites: Sequence[str],
        *,
        feet: Sequence[str] = (),
        contacts: ContactSensors | None = None,
        ahead: float = 0.0,
    ) -> None:
        self.model, self._ahead = model, ahead
        self.base_body = model.body(base).id
        self._views = BodyViews(model, self.base_body, model.body(torso).id)
        self.sites: Indices = np.array([model.site(name).id for name in sites], dtype=np.intp)
        self.mass = float(model.body_subtreemass[self.base_body])
        self._feet, self._contacts = feet, contacts
        self._soles: Soles | None = None
        self._observation: Observation | None = None

    def update(self, observation: Observation) -> "RobotState":
        """Take the observation of this tick, and return the state itself.

        An observation that it has already costs nothing, and a new one only the storing.
        """
        if observation is not self._observation:
            self._observation = observation
            known = self.__dict__
            for name in PER_OBSERVATION:
                known.pop(name, None)
        return self

    @property
    def observation(self) -> Observation:
        """The observation that it belongs to.

        Raises:
            StateMissingError: There has been none yet.
        """
        if self._observation is None:
            raise StateMissingError("no observation has been taken yet")
        return self._observation

    @property
    def base(self) -> BaseState:
        """State of the base: measured on a twin, else estimated.

        Raises:
            StateMissingError: The observation has no base.
        """
        base = self.observation.base
        if base is None:
            raise StateMissingError("the base state is missing; run with `--state estimated`")
        return base

    @property
    def soles(self) -> Soles:
        """The points of the soles that can touch the ground.

        Raises:
            UsageError: A foot has no geom that it could stand on.
        """
        if self._soles is None:
            assert self._contacts is not None, "the feet are given where their points are read"
            self._soles = Soles(self.model, self._feet, self._contacts)
        return self._soles

    @ComputedOnce
    def position_stage(self) -> BodyViews:
        """Poses of all bodies and centres of mass, in MuJoCo's data."""
        views, base, joints = self._views, self.base, self.observation.joints
        qpos, qvel = views.qpos, views.qvel
        qpos[:3], qpos[3:7], qpos[7:] = base.position, base.orientation, joints.position
        qvel[:3], qvel[3:6], qvel[6:] = base.linear_velocity, base.angular_velocity, joints.velocity
        if self._ahead:
            mujoco.mj_integratePos(self.model, qpos, qvel, self._ahead)
        mujoco.mj_kinematics(self.model, views.data)
        mujoco.mj_comPos(self.model, views.data)
        return views

    @ComputedOnce
    def velocity_stage(self) -> BodyViews:
        """The same, with the velocities of all bodies."""
        views = self.position_stage
        mujoco.mj_comVel(self.model, views.data)
        return views

    @ComputedOnce
    def joint_position(self) -> Array:
        """(n,) joint positions, rad."""
        return self.position_stage.qpos[7:].copy()

    @ComputedOnce
    def velocity(self) -> Array:
        """(v,) linear velocity of the base, its angular velocity in its frame, joint velocities."""
        return self.position_stage.qvel.copy()

    @ComputedOnce
    def pose(self) -> Pose:
        """Pose of the base."""
        return Pose(self.position_stage.position.copy(), self.position_stage.axes.copy())

    @ComputedOnce
    def yaw(self) -> float:
        """Heading of the base, rad."""
        return facing(self.pose.rotation)

    @ComputedOnce
    def up(self) -> Array:
        """(3,) unit vector along the torso."""
        return self.position_stage.up.copy()

    @ComputedOnce
    def feet(self) -> list[Pose]:
        """Poses of the k sites."""
        axes = self.feet_axes.reshape(-1, 3, 3)
        return [Pose(*pose) for pose in zip(self.feet_position, axes, strict=True)]

    @ComputedOnce
    def feet_position(self) -> Array:
        """(k, 3) positions of the k sites, m."""
        return self.position_stage.site_position[self.sites]

    @ComputedOnce
    def feet_axes(self) -> Array:
        """(k, 9) rotation matrices of the k sites, row by row."""
        return self.position_stage.site_axes[self.sites]

    @ComputedOnce
    def ground(self) -> Array:
        """(p, 3) the points of the soles that can touch the ground, m; see `soles`."""
        views = self.position_stage
        return self.soles.seen(views.body_position, views.body_axes)

    @ComputedOnce
    def com(self) -> Array:
        """(3,) centre of mass, m."""
        return self.position_stage.com.copy()

    @ComputedOnce
    def momenta(self) -> Momenta:
        """Mass, centre of mass and momenta of the whole body."""
        views = self.velocity_stage
        mujoco.mj_subtreeVel(self.model, views.data)
        return Momenta(self.mass, self.com, views.com_velocity.copy(), views.angular.copy())

    @property
    def com_velocity(self) -> Array:
        """(3,) velocity of the centre of mass, m/s."""
        return self.momenta.velocity

    @ComputedOnce
    def com_jacobian(self) -> Array:
        """(3, v) Jacobian of the centre of mass."""
        jacobian = np.zeros((3, self.model.nv))
        mujoco.mj_jacSubtreeCom(self.model, self.position_stage.data, jacobian, self.base_body)
        return jacobian

    @ComputedOnce
    def outcomes(self) -> Outcomes:
        """The state as a batch of one, as rollouts return theirs."""
        base, observation = self.base, self.observation
        return Outcomes(
            duration=np.zeros(1),
            base_position=base.position[None],
            base_orientation=base.orientation[None],
            base_velocity=self.velocity[None, :6],
            joint_position=observation.joints.position[None],
            com=self.com[None],
            com_velocity=self.com_velocity[None],
            feet=self.feet_position[None],
            torso=self.up[None],
            contacts=observation.contacts[None],
            fell=np.zeros(1, dtype=bool),
        )

    @ComputedOnce
    def _jacobians(self) -> dict[int, Array]:
        return {}

    @ComputedOnce
    def _supports(self) -> "dict[tuple[int, ...], SupportRegion]":
        return {}

    def jacobian(self, foot: int) -> Array:
        """Return the Jacobian (6, v) of a sole's centre: linear, then angular."""
        known = self._jacobians.get(foot)
        if known is None:
            known = self._jacobians[foot] = np.zeros((6, self.model.nv))
            site = int(self.sites[foot])
            mujoco.mj_jacSite(self.model, self.position_stage.data, known[:3], known[3:], site)
        return known

    def points(self, sites: Indices) -> Array:
        """Return the positions (s, 3) of sites by their indices (s,), m."""
        return self.position_stage.site_position[sites]

    def support(self, feet: Sequence[int]) -> "SupportRegion":
        """Return the convex hull of these feet's soles, whether or not they bear load."""
        which = tuple(feet)
        known = self._supports.get(which)
        if known is None:
            from windup.control.kinematics.support import SupportRegion  # Shapely loads slowly

            of_these = self.soles.members[list(which)].any(axis=0)
            known = self._supports[which] = SupportRegion.hull(self.ground[of_these])
        return known


PER_OBSERVATION = computed_once(RobotState)
"""Quantities that are discarded at the next observation."""
