"""The feet of an observed robot: their measured places, and joint angles for target places."""

from collections.abc import Sequence
from math import atan2

import mujoco
import numpy as np

from windup.control.execution.motion import Planted
from windup.control.kinematics.limb_ik import LimbIk, Pose
from windup.control.kinematics.momenta import Momenta
from windup.control.kinematics.robot_state import RobotState
from windup.control.kinematics.rotation import (
    quaternion_matrix,
    turn,
    turn_about_y,
    yaw_of,
)
from windup.control.kinematics.support import SupportRegion
from windup.hal.joints import Array
from windup.hal.observation import Observation

DOWN = 0.004
"""Maximum height of a grounded foot's lowest point above the lowest point of all feet, m."""
ITERATIONS = 2
"""Iterations of the inverse kinematics per tick, started at the solution of the last tick."""


class Footing:
    """Measured feet and base of a robot, and inverse kinematics of its legs.

    Args:
        state: The robot's state, with the points of its soles.
        base: Name of the body with the free joint.
        sites: Names of the sites at the soles' centres, one per foot.
        stance: (n,) rad, joint positions of the pose to stand in, with both soles flat.

    Attributes:
        momenta: Momenta of the whole body.
        base: Pose of the base.
        yaw: Heading of the base, rad.
        feet: Poses of the soles' centres.
        places: (k, 2) horizontal positions of the soles' centres, m.
        down: For each foot, whether it is on the ground.
        height: Height of the base above the soles in the stance, m.
        rounded: Support regions are circles and capsules instead of hulls.
    """

    momenta: Momenta
    base: Pose
    yaw: float
    feet: list[Pose]
    places: Array
    down: list[bool]

    def __init__(self, state: RobotState, base: str, sites: Sequence[str], stance: Array) -> None:
        self.state, self._rows = state, state.soles.rows
        self.rounded = False
        self._home_of: Planted | None = None
        self._limbs = [LimbIk(state.model, base, site) for site in sites]
        self._last = [stance.copy() for _ in sites]
        homes = [limb.forward(stance) for limb in self._limbs]
        front = homes[0].rotation
        self._level = turn_about_y(atan2(front[0, 2], front[2, 2])).T
        self.homes = [self._level @ home.position for home in homes]
        self.height = -float(np.mean([home[2] for home in self.homes]))
        self._offset = -np.mean([home[:2] for home in self.homes], axis=0)

    def update(self, observation: Observation) -> None:
        """Update all measured attributes.

        Raises:
            StateMissingError: The observation has no base.
        """
        state = self.state.update(observation)
        self.momenta, self.base, self.yaw = state.momenta, state.pose, state.yaw
        self.feet, self.places = state.feet, state.feet_position[:, :2]
        heights = [self.ground(foot)[:, 2].min() for foot in range(len(self.feet))]
        self.down = [height < min(heights) + DOWN for height in heights]

    def ground(self, foot: int) -> Array:
        """Return the points (p, 3) of a sole in the world frame, m."""
        return self.state.ground[self._rows[foot]]

    def reach_yaw(self, stance: int) -> float:
        """Return the heading, rad, of a foot's reach: the base's, under which the hips are."""
        return self.yaw

    def middle(self, foot: int) -> Array:
        """Return the middle (2,) of a sole on the ground, m: its site is there."""
        return np.asarray(self.places[foot])

    def support(self, feet: Sequence[int]) -> SupportRegion:
        """Return the support region of these feet's soles, whether or not they bear load."""
        if self.rounded:
            return SupportRegion.rounded([self.ground(foot) for foot in feet])
        return self.state.support(feet)

    def planted(self) -> Planted:
        """Return the measured places of the feet, to hold them there."""
        places = np.zeros((len(self.feet), 3))
        places[:, :2] = self.places
        return Planted(places, np.array([yaw_of(foot.rotation) for foot in self.feet]))

    def home(self, planted: Planted) -> Array:
        """Return the base's position (2,) m in the stance, for feet at these places."""
        if planted is not self._home_of:
            middle = planted.places[:, :2].mean(axis=0)
            self._home = middle + turn(planted.front)[:2, :2] @ self._offset
            self._home_of = planted
        return self._home

    def upright(
        self, place: Array, heading: float, pitch: float = 0.0, height: float | None = None
    ) -> Pose:
        """Return the pose of the base as in the stance, at a given place.

        Args:
            place: (2,) horizontal position, m.
            heading: Heading, rad.
            pitch: Additional forward lean, rad.
            height: Height above the ground, m; that of the stance by default.
        """
        position = np.array([place[0], place[1], self.height if height is None else height])
        return Pose(position, turn(heading) @ turn_about_y(pitch) @ self._level)

    def ahead(self, time: float) -> Pose:
        """Return the pose of the base in `time` s, extrapolated at its present velocities."""
        state = self.state.base
        orientation = state.orientation.copy()
        mujoco.mju_quatIntegrate(orientation, state.angular_velocity, time)
        position = state.position + time * state.linear_velocity
        return Pose(position, quaternion_matrix(orientation))

    def put(self, goals: Array, foot: int, at: Array, heading: float, base: Pose) -> None:
        """Set the joints of a leg in `goals` (n,) so that its sole is flat at `at` (3,) m.

        Args:
            goals: (n,) joint goals, rad, changed in place.
            foot: Index of the foot.
            at: (3,) target of the sole's centre, m.
            heading: Target heading of the sole, rad.
            base: Pose of the base for which the goals are meant.
        """
        self._solve(goals, foot, Pose(at, turn(heading)).seen_from(base))

    def keep(self, goals: Array, foot: int, planted: Planted, base: Pose) -> None:
        """Set the joints of a leg in `goals` (n,) so that its sole stays at its place in `planted`.

        The measured place is ignored, even if the foot slips, or lifts while the robot tips.
        """
        self.put(goals, foot, planted.places[foot], planted.yaws[foot], base)

    def _solve(self, goals: Array, foot: int, target: Pose) -> None:
        limb = self._limbs[foot]
        angles = limb.solve(target, self._last[foot], ITERATIONS)
        self._last[foot][limb.joints] = angles
        goals[limb.joints] = angles
