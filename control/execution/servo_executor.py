"""Steps that prevent a fall on position servos.

They are slow and late: the stance leg is held stiffly and the robot tips over it, and the other
foot is lifted as fast as possible. No path of the CoM is followed in a swing; a base that stays
where it was does better (62 to 52 of 100 pushes in a prototype).
"""

from typing import Protocol

import numpy as np

from windup.control.execution.footing import Footing
from windup.control.execution.motion import Motion, Planted, Swing, cosine_progress
from windup.control.execution.swing import gaussian_progress
from windup.control.kinematics.momenta import capture_point
from windup.control.kinematics.robot_state import RobotState
from windup.control.kinematics.rotation import facing, heading_between, turn
from windup.hal.command import JointCommand
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

MOST_SHIFT = 0.06
"""Maximum displacement of the base against the capture point, m."""
MOST_PITCH = 0.8
"""Maximum additional pitch of the trunk, rad."""
TAKE = 0.6
"""Time after a takeover in which height, arms and head change to those of the stance, s."""


class ServoGains(Protocol):
    """What `stepping.toml` says of a step with position servos."""

    @property
    def up(self) -> float:
        """Fraction of the step after which the foot is lowered."""
        ...

    @property
    def lead(self) -> float:
        """Time by which the goals are ahead, s."""
        ...

    @property
    def settle(self) -> float:
        """Time in which the base returns over the feet, s."""
        ...

    @property
    def balance(self) -> float:
        """Displacement of the base against the capture point, as a ratio."""
        ...

    @property
    def trunk(self) -> float:
        """Backward pitch of the trunk per forward distance of the capture point, rad/m."""
        ...


class ServoExecutor:
    """Realises steps with the joint angles of both legs.

    Args:
        joints: The robot's joints.
        feet: The robot's feet.
        stance: (n,) rad, the pose to stand in.
        gains: Times and gains.

    Attributes:
        state: The robot's state.
    """

    def __init__(self, joints: Joints, feet: Footing, stance: Array, gains: ServoGains) -> None:
        self.joints, self.feet, self.stance, self._gains = joints, feet, stance, gains
        self.state: RobotState = feet.state
        self._hold = JointCommand.hold(joints, stance)

    def reset(self, observation: Observation) -> None:
        """Start in the stance; see `Executor.reset`."""
        self._hold = JointCommand.hold(self.joints, self.stance)
        self._taken = -np.inf
        self._before, self._above = self.stance, self.feet.height
        self.feet.update(observation)

    def take(self, observation: Observation) -> None:
        """Start from any state; height, arms and head come to the stance in `TAKE` s."""
        self.reset(observation)
        self._taken = observation.time
        self._before = observation.joints.position.copy()
        lowest = min(foot.position[2] for foot in self.feet.feet)
        self._above = float(self.feet.base.position[2] - lowest)

    def observe(self, observation: Observation) -> None:
        """Measure the feet; see `Executor.observe`."""
        self.feet.update(observation)

    def due(self, now: float, dt: float) -> bool:
        """Return True: joint angles are computed at every tick."""
        return True

    def touches(self, foot: int) -> bool:
        """Return True: the servos press the foot down, and no bus carries foot switches."""
        return True

    @property
    def weight(self) -> Array:
        """(2,) measured position of the base, m."""
        return self.feet.base.position[:2].copy()

    def ease(self, part: float) -> float:
        """Return the fraction of a shift done at the fraction `part` of the time: a cosine."""
        return cosine_progress(part)

    def over(self, foot: int) -> Array:
        """Return the position (2,) of the base with the CoM over a foot, m."""
        com = self.feet.momenta.com[:2] - self.feet.base.position[:2]
        return np.asarray(self.feet.places[foot] - com)

    def home(self, planted: Planted) -> Array:
        """Return the position (2,) of the base in the stance, m."""
        return self.feet.home(planted)

    def anchor(self, motion: Motion, now: float) -> Array:
        """Return the desired position (2,) of the base; it returns over the feet after a step."""
        here = self.feet.base.position[:2]
        return np.asarray(here + self._back(motion, now) * (motion.shift.goal - here))

    def lift_off(self, foot: int, planted: Planted) -> Array:
        """Return the place (3,) of the sole on the ground, m."""
        return planted.places[foot]

    def realise(self, motion: Motion, now: float, dt: float) -> JointCommand:
        """Return the joint angles of this tick."""
        part = min((now - self._taken) / TAKE, 1.0)
        goals = self._before + part * (self.stance - self._before)
        self._height = self._above + part * (self.feet.height - self._above)
        if motion.yaw is not None:
            self._follow(goals, motion, motion.yaw, now)
        elif motion.swing is not None:
            self._step(goals, motion, motion.swing, now)
        else:
            self._balance(goals, motion, now)
        return self._hold.with_position(goals)

    def _follow(self, goals: Array, motion: Motion, yaws: tuple[float, float], now: float) -> None:
        """Set the goals of the legs in `goals` (n,): the base follows the path of the weight."""
        feet, shift = self.feet, motion.shift
        part = shift.ease(shift.part(now))
        base = feet.upright(shift.at(now), heading_between(*yaws, part))
        swing = motion.swing
        if swing is not None:
            at, _ = swing.at(now)
            feet.put(goals, swing.foot, at, heading_between(*swing.yaw, part), base)
        for foot in (0, 1):
            if swing is None or foot != swing.foot:
                feet.keep(goals, foot, motion.planted, base)

    def _balance(self, goals: Array, motion: Motion, now: float) -> None:
        """Set the goals of both legs: the base over the feet, displaced against a fall."""
        feet = self.feet
        place = self.anchor(motion, now) - self._against((feet.places[0] + feet.places[1]) / 2.0)
        heading = heading_between(feet.yaw, motion.planted.front, self._back(motion, now))
        base = feet.upright(place, heading, height=self._height)
        for foot in (0, 1):
            feet.keep(goals, foot, motion.planted, base)

    def _step(self, goals: Array, motion: Motion, swing: Swing, now: float) -> None:
        """Set the goals of a swing: one leg stiff, the other foot at its place in `lead` s."""
        feet, gains, gone = self.feet, self._gains, now - swing.began
        way = gaussian_progress((gone + gains.lead) / swing.duration)
        at = np.zeros(3)
        at[:2] = swing.start[:2] + way * (swing.target - swing.start[:2])
        # The height is a step function: the servos are too slow for a smooth curve.
        at[2] = swing.height if gone < gains.up * swing.duration else 0.0
        # The trunk turns until then, and the foot should have its heading.
        seen = feet.ahead(gains.lead)
        feet.put(goals, swing.foot, at, facing(seen.rotation), seen)
        pivot = feet.places[1 - swing.foot]
        ahead = float(turn(feet.yaw)[:2, 0] @ (capture_point(feet.momenta) - pivot))
        pitch = np.clip(-gains.trunk * ahead, -MOST_PITCH, MOST_PITCH)
        place = swing.anchor - self._against(pivot)
        base = feet.upright(place, feet.yaw, float(pitch), self._height)
        feet.keep(goals, 1 - swing.foot, motion.planted, base)

    def _back(self, motion: Motion, now: float) -> float:
        """Return the progress of the base's return over the feet after a step, 0 to 1."""
        return min((now - motion.landed) / max(self._gains.settle, 1e-6), 1.0)

    def _against(self, middle: Array) -> Array:
        """Return the displacement (2,) m to subtract from the base against the capture point."""
        away = self._gains.balance * (capture_point(self.feet.momenta) - middle)
        return np.minimum(np.maximum(away, -MOST_SHIFT), MOST_SHIFT)
