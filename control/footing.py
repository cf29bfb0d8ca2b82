"""The feet of an observed robot: where they stand, and joint angles that put them elsewhere."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2

import mujoco
import numpy as np

from control.body import Body
from control.limb_ik import LimbIk, Pose
from control.momenta import Momenta
from control.rotation import facing, quaternion_matrix, turn, turn_about_y, yaw_of
from control.soles import Soles
from control.support import SupportRegion
from hal.errors import StateMissingError
from hal.joints import Array
from hal.observation import Observation

DOWN = 0.004
"""A foot is down when its lowest point is not higher than this above the lowest of all, m."""
ITERATIONS = 2
"""Of the inverse kinematics in a tick; each one begins where the last tick ended."""


@dataclass(frozen=True)
class Planted:
    """Where feet stood at some time.

    Attributes:
        places: (k, 3) of the soles' centres, on the ground, m.
        yaws: (k,) rad.
        home: Where (2,) m the base is over them in the stance.
        front: Heading between them, rad.
    """

    places: Array
    yaws: list[float]
    home: Array
    front: float


class Footing:
    """Where a robot's feet are, and how to put them and the base where they should be.

    Args:
        body: Kinematics of the robot.
        base: Name of the body with the free joint.
        sites: Names of the sites at the soles' centres, one a foot.
        soles: Where the soles can touch the ground.
        stance: (n,) rad, joint positions of the pose to stand in, with both soles flat.

    Attributes:
        momenta: Momenta of the whole body.
        base: Pose of the base.
        yaw: Heading of the base, rad.
        feet: Poses of the soles' centres.
        places: (k, 2) where these are on the ground, m.
        front: Heading between the feet, rad: where a base that stands on them should face.
        down: Which feet are on the ground.
        height: Of the base above the soles in the stance, m.
        rounded: Take circles and a capsule for what the soles support, not their hull.
    """

    momenta: Momenta
    base: Pose
    yaw: float
    feet: list[Pose]
    places: Array
    front: float
    down: list[bool]

    def __init__(
        self, body: Body, base: str, sites: Sequence[str], soles: Soles, stance: Array
    ) -> None:
        self._body, self._soles = body, soles
        self.rounded = False
        self._limbs = [LimbIk(body.model, base, site) for site in sites]
        self._last = [stance.copy() for _ in sites]
        homes = [limb.forward(stance) for limb in self._limbs]
        front = homes[0].rotation
        self._level = turn_about_y(atan2(front[0, 2], front[2, 2])).T
        self.homes = [self._level @ home.position for home in homes]
        self.height = -float(np.mean([home[2] for home in self.homes]))
        self._offset = -np.mean([home[:2] for home in self.homes], axis=0)

    def look(self, observation: Observation) -> None:
        """Measure everything anew.

        Raises:
            StateMissingError: The observation has no base.
        """
        self._body.measure(observation)
        state = observation.base
        if state is None:
            raise StateMissingError("the base state is missing; run with `--state estimated`")
        data = self._body.data
        self.momenta = self._body.momenta()
        self.base = Pose(state.position, quaternion_matrix(state.orientation))
        self._state = state
        self.yaw = facing(self.base.rotation)
        sites = self._body.soles
        self.feet = [
            Pose(data.site_xpos[site].copy(), data.site_xmat[site].reshape(3, 3).copy())
            for site in sites
        ]
        self.places = data.site_xpos[sites, :2].copy()
        x, y = (sum(foot.rotation[axis, 0] for foot in self.feet) for axis in (0, 1))
        self.front = atan2(y, x)
        self._ground = self._soles.seen(data)
        heights = [self._ground[self._soles.foot == k, 2].min() for k in range(len(sites))]
        self.down = [height < min(heights) + DOWN for height in heights]

    def ground(self, foot: int) -> Array:
        """Return the points (p, 3) m of a sole in the world."""
        return self._ground[self._soles.foot == foot]

    def support(self, feet: Sequence[int]) -> SupportRegion:
        """Return what these feet's soles can support, whether or not they bear load."""
        if self.rounded:
            return SupportRegion.rounded([self.ground(foot) for foot in feet])
        of_these = self._soles.members[list(feet)].any(axis=0)
        return SupportRegion.hull(self._ground[of_these])

    def home(self) -> Array:
        """Return where (2,) m the base is in the stance, over the feet of now."""
        return self.places.mean(axis=0) + turn(self.front)[:2, :2] @ self._offset

    def planted(self) -> Planted:
        """Return where the feet are, to keep them there: feet that slip are not followed."""
        places = np.zeros((len(self.feet), 3))
        places[:, :2] = self.places
        return Planted(
            places, [yaw_of(foot.rotation) for foot in self.feet], self.home(), self.front
        )

    def upright(self, place: Array, heading: float, pitch: float = 0.0) -> Pose:
        """Return the stance's pose of the base over a place.

        Args:
            place: (2,) m.
            heading: rad.
            pitch: How far it leans forward from there, rad.
        """
        position = np.array([place[0], place[1], self.height])
        return Pose(position, turn(heading) @ turn_about_y(pitch) @ self._level)

    def ahead(self, time: float) -> Pose:
        """Return where the base will be in `time` s if it goes on as it does."""
        state = self._state
        orientation = state.orientation.copy()
        mujoco.mju_quatIntegrate(orientation, state.angular_velocity, time)
        position = state.position + time * state.linear_velocity
        return Pose(position, quaternion_matrix(orientation))

    def stand(self, goals: Array, foot: int, base: Pose) -> None:
        """Set the joints of a leg in `goals` (n,) so that `base` is over its sole, flat as it is.

        Args:
            goals: rad, changed in place.
            foot: Which foot.
            base: Where the base should be, as far above the sole as above the ground.
        """
        sole = self.feet[foot]
        level = turn(yaw_of(sole.rotation))
        place = np.array([sole.position[0], sole.position[1], 0.0])
        self._solve(goals, foot, Pose(place, level).seen_from(base))

    def put(self, goals: Array, foot: int, at: Array, heading: float, base: Pose) -> None:
        """Set the joints of a leg in `goals` (n,) so that its sole is flat at `at` (3,) m.

        Args:
            goals: rad, changed in place.
            foot: Which foot.
            at: Where its sole's centre should be.
            heading: Of the sole, rad.
            base: Where the base will be by then.
        """
        self._solve(goals, foot, Pose(at, turn(heading)).seen_from(base))

    def missed(self, foot: int) -> float:
        """Return how far out of reach the last place of a foot was, m."""
        return self._limbs[foot].missed

    def _solve(self, goals: Array, foot: int, target: Pose) -> None:
        limb = self._limbs[foot]
        angles = limb.solve(target, self._last[foot], ITERATIONS)
        self._last[foot][limb.joints] = angles
        goals[limb.joints] = angles
