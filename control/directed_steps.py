"""Walks footprints, one slow step after the other: the weight goes over the foot that stays first.

Everything is planned from the feet as they are measured, so that errors do not pile up. The goals
carry what the servos need to hold the weight, and run ahead of the swinging leg.
"""

from collections.abc import Sequence
from math import atan2, sin
from typing import Literal

import numpy as np

from control.body import Body, heading
from control.directed_file import ServoDirected
from control.footprints import Footprint, between, ground_places, onto, seen_from
from control.limb_ik import LimbIk, Pose
from control.rotation import quaternion_matrix, turn, turn_between
from control.swing import gaussian_progress, lift
from control.weight import holding_torque
from hal.command import JointCommand
from hal.errors import StateMissingError
from hal.joints import Array, Joints
from hal.observation import Observation

Phase = Literal["shift", "swing", "land", "rest"]
MOST_SHIFT, MOST_TILT = 0.02, 0.1
"""Most that is made up for, m and rad."""
TAKE_OFF = 0.2
"""Part of the swing in which the leg goes over from bearing to flying."""
PRESS = 0.002
"""How far into the ground a foot is put, so that it touches with certainty, m."""
FAST, SMOOTH = 4.8, 0.02
"""Most speed of a goal that is told beforehand, rad/s, and the time it is smoothed in, s."""
ITERATIONS = 3
"""Of the inverse kinematics in a tick; each one begins where the last tick ended."""


class DirectedSteps:
    """Takes the steps of a list of footprints, and comes to rest between the feet.

    Args:
        joints: The robot's joints.
        body: Kinematics of the robot.
        base: Name of the body with the free joint.
        limbs: Inverse kinematics of its two legs, in the order of its soles.
        stance: (n,) rad, the pose to start from; joints of no leg keep it.
        prints: What to do.
        how: Gains and times.

    Attributes:
        finished: All steps are done and the weight is between the feet.
        landed: How many feet have come down.
        stood: How many of these have borne the weight since, as they were told.
        places: (2, 3) where the feet are now.
        target: (3,) where the last one should have come down, seen from the foot that stayed.
    """

    places: Array
    target: Array

    def __init__(
        self,
        joints: Joints,
        body: Body,
        base: str,
        limbs: Sequence[LimbIk],
        stance: Array,
        prints: Sequence[Footprint],
        how: ServoDirected,
    ) -> None:
        self.joints, self.body, self.base, self.limbs = joints, body, base, limbs
        self.stance, self.prints, self.how = stance, prints, how
        self.finished, self.landed, self.stood = False, 0, 0

    def reset(self, observation: Observation) -> None:
        """Begin where the feet are."""
        self._look(observation)
        self._origin = between(*self.places)
        self._hold = JointCommand.hold(self.joints, self.stance)
        self._last = [observation.joints.position.copy() for _ in self.limbs]
        self._before: Array | None = None
        self._lead = np.zeros(len(self.joints))
        self._apart = seen_from(*self.places)
        self._shift, self._tilt = np.zeros(2), np.zeros(3)
        self._com, self._yaw = self._mass[:2].copy(), self._turned
        self._height = float(self._pose.position[2]) - self._ground
        self.finished, self.landed, self.stood, self._foot = False, 0, 0, 0
        self._share = 0.5
        self._torque = np.zeros(len(self.joints))
        self._enter("rest", observation.time)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of now."""
        self._look(observation)
        self._advance(observation.time)
        self._plan(self._part(observation.time))
        base = self._base(dt)
        goals = self.stance.copy()
        for foot in range(2):
            self._solve(goals, foot, self._sole(foot).seen_from(base))
        if self._phase in ("swing", "land"):
            self._swing(goals)
        block = self._hold.block.copy()
        np.clip(goals, self.joints.lower, self.joints.upper, out=block[0])
        if self._before is not None:
            speed = (block[0] - self._before) / dt
            self._lead += min(dt / SMOOTH, 1.0) * (np.clip(speed, -FAST, FAST) - self._lead)
        block[1] = self._lead
        self._before = block[0].copy()
        torque = holding_torque(self.body, self.base, (1.0 - self._share, self._share))
        self._torque += min(dt / self.how.slow, 1.0) * (torque - self._torque)
        block[2] = self._torque
        return JointCommand(block)

    def _look(self, observation: Observation) -> None:
        """Measure the feet, the centre of mass and the base."""
        state = observation.base
        if state is None:
            raise StateMissingError("the base state is missing; run with `--state estimated`")
        out = self.body.measure(observation)
        self.places = ground_places(out.feet[0], self.body.data.site_xmat[self.body.soles])
        self._mass, self._speed = out.com[0], out.com_velocity[0, :2]
        self._pose = Pose(state.position, quaternion_matrix(state.orientation))
        self._rate = self._pose.rotation @ state.angular_velocity * np.array([1.0, 1.0, 0.0])
        self._turned = float(heading(state.orientation))
        heights = out.feet[0, :, 2]
        self._ground = float(heights.min())

    def _enter(self, phase: Phase, now: float) -> None:
        """Begin a phase."""
        self._phase, self._began = phase, now
        self._from = (self._com.copy(), self._height, self._yaw, self._share)
        if phase == "shift":
            self._foot = self.prints[self.landed].foot
        if phase == "swing":
            self._aim()
        if phase == "land":
            stance = self.places[1 - self._foot]
            there = onto(stance, self.target)
            pair = (there, stance) if self._foot == 0 else (stance, there)
            self._apart = seen_from(*pair)
        self._to = self._goal(phase)

    def _aim(self) -> None:
        """Fix where the foot should come down, seen from the one that stays."""
        wanted = self.prints[self.landed]
        stance = self.places[1 - self._foot]
        self._left = seen_from(stance, self.places[self._foot])
        self.target = wanted.place
        if wanted.frame == "start":
            self.target = seen_from(stance, onto(self._origin, wanted.place))

    def _goal(self, phase: Phase) -> tuple[Array, float, float, float]:
        """Return where centre of mass, height, yaw and share of the second foot should go."""
        middle = between(*self.places)
        if phase == "rest":
            return middle[:2], self.how.height, self._yaw + _turn(self._yaw, middle[2]), 0.5
        stance = self.places[1 - self._foot]
        yaw = self._yaw
        if phase == "swing":
            yaw += _turn(yaw, between(stance, onto(stance, self.target))[2])
        return stance[:2].copy(), self.how.height, yaw, float(1 - self._foot)

    def _seconds(self) -> float:
        if self._phase == "swing":
            return self.prints[self.landed].duration or self.how.swing
        return self.how.land if self._phase == "land" else self.how.shift

    def _part(self, now: float) -> float:
        return min((now - self._began) / self._seconds(), 1.0)

    def _advance(self, now: float) -> None:
        """Go on to the next phase when it is time."""
        if now - self._began < self._seconds() - 1e-9 or self.finished:
            return
        if self._phase in ("shift", "rest"):
            self.stood = self.landed
        if self._phase == "shift":
            if self._calm() or now - self._began > self.how.patience * self._seconds():
                self._enter("swing", now)
        elif self._phase == "swing":
            self._enter("land", now)
        elif self._phase == "land":
            self.landed += 1
            self._enter("shift" if self.landed < len(self.prints) else "rest", now)
        elif self.landed < len(self.prints):
            self._enter("shift", now)
        else:
            self.finished = True

    def _calm(self) -> bool:
        """The weight is over the foot that stays, and rests."""
        away = np.hypot(*(self._mass[:2] - self._to[0]))
        return bool(away < self.how.near and np.hypot(*self._speed) < self.how.quiet)

    def _plan(self, part: float) -> None:
        """Set where centre of mass, height, yaw and shares should be now."""
        self._now = part
        s = part**3 * (10.0 - 15.0 * part + 6.0 * part * part)
        begin, end = self._from, self._to
        self._com = begin[0] + s * (end[0] - begin[0])
        pace = 30.0 * (part * (1.0 - part)) ** 2 / self._seconds()
        self._com_speed = pace * (end[0] - begin[0])
        self._height = begin[1] + s * (end[1] - begin[1])
        self._yaw = begin[2] + s * (end[2] - begin[2])
        self._share = begin[3] + s * (end[3] - begin[3])

    def _base(self, dt: float) -> Pose:
        """Return where the base should be for that, with what is lasting made up for."""
        error = self._com - self._mass[:2]
        slow = self._speed - self._com_speed
        self._shift = np.clip(self._shift + self.how.follow * dt * error, -MOST_SHIFT, MOST_SHIFT)
        wanted = turn(self._yaw)
        lean = turn_between(self._pose.rotation, wanted)
        self._tilt = np.clip(self._tilt + self.how.follow * dt * lean, -MOST_TILT, MOST_TILT)
        offset = wanted @ self._pose.rotation.T @ (self._pose.position - self._mass)
        place = self._com + offset[:2] + self._shift + self.how.hold * error - self.how.brake * slow
        tilt = self._tilt + self.how.level * lean - self.how.steady * self._rate
        return Pose(np.array([*place, self._ground + self._height]), _small(tilt) @ wanted)

    def _sole(self, foot: int) -> Pose:
        """Return where the sole on the ground should be.

        The one that bears more is where it is; the other one as far from it as it came down, or
        small forces between the feet would let it creep.
        """
        x, y, yaw = self.places[foot] + self._creep(foot)
        return Pose(np.array([x, y, self._ground]), turn(yaw))

    def _creep(self, foot: int) -> Array:
        """Return how far (3,) a foot on the ground should go back, m and rad."""
        one, other = self.places
        if self._phase == "swing":
            return np.zeros(3)
        if foot == 1:
            away = onto(one, self._apart) - other
            return (1.0 - self._share) * np.array([*away[:2], _turn(0.0, away[2])])
        back = seen_from(onto(np.zeros(3), self._apart), np.zeros(3))
        away = onto(other, back) - one
        return self._share * np.array([*away[:2], _turn(0.0, away[2])])

    def _swing(self, goals: Array) -> None:
        """Set the leg in the air, from where the base is; on the ground from where it should be."""
        limb = self.limbs[self._foot]
        standing = goals[limb.joints].copy()
        self._solve(goals, self._foot, self._flying().seen_from(self._pose))
        stand = self._now if self._phase == "land" else max(1.0 - self._now / TAKE_OFF, 0.0)
        goals[limb.joints] += stand * (standing - goals[limb.joints])

    def _flying(self) -> Pose:
        """Return where the sole in the air should be."""
        if self._phase == "land":
            x, y, yaw = onto(self.places[1 - self._foot], self.target)
            return Pose(np.array([x, y, self._ground - PRESS]), turn(yaw))
        s = gaussian_progress(self._now)
        away = self._left + s * (self.target - self._left)
        x, y, yaw = onto(self.places[1 - self._foot], away)
        return Pose(np.array([x, y, self._ground + lift(self._now, self.how.lift)]), turn(yaw))

    def _solve(self, goals: Array, foot: int, target: Pose) -> None:
        limb = self.limbs[foot]
        angles = limb.solve(target, self._last[foot], ITERATIONS)
        self._last[foot][limb.joints] = angles
        goals[limb.joints] = angles


def _turn(one: float, other: float) -> float:
    """Return the shorter way from one direction to the other, rad."""
    return float(atan2(sin(other - one), np.cos(other - one)))


def _small(turned: Array) -> Array:
    """Return the rotation (3, 3) of a small turn (3,) rad."""
    x, y, z = turned
    matrix = np.array([[1.0, -z, y], [z, 1.0, -x], [-y, x, 1.0]])
    q, r = np.linalg.qr(matrix)
    return q * np.sign(np.diag(r))
