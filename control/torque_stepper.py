"""Stands, and steps where a push asks for it, with torques from whole-body control.

Wu & Zordan 2010: the supervisor (section 4) decides when and where, two curves (section 5) say
where the centre of mass and the swing foot should be, and the whole-body optimisation makes
accelerations of that, at its own rate; inverse dynamics makes torques of these at every tick.
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from control.momenta import capture_point
from control.rotation import turn, turn_between, yaw_of
from control.step_decision import (
    Placement,
    StepRule,
    choose,
    coming_point,
    landing_point,
    needs_step,
    place,
    trigger_point,
)
from control.stepping_file import Stepping
from control.support import SupportRegion
from control.swing import bezier, gaussian_progress, lift
from control.whole_body import Objectives, Plan, WholeBody
from hal.command import JointCommand
from hal.joints import Array, Joints
from hal.observation import Observation

Phase = Literal["stand", "swing", "land"]
PERIOD = 0.005
"""Of the optimisation, s."""
COM_GAIN, COM_DAMPING = 40.0, 12.0
"""k_L, 1/s2, and d_L, 1/s, of Eq. 10."""
POSE_GAIN, POSE_DAMPING = 100.0, 20.0
"""k_T and d_T of Eq. 9."""
SWING_GAIN, SWING_DAMPING = 900.0, 60.0
"""The same of the swing foot, and of the attitude of the trunk a third of it."""
SPIN_DAMPING = 5.0
"""d_z of Eq. 11, 1/s."""
STILL_DAMPING = 20.0
"""Damping of a standing foot, 1/s."""
FOLLOW_DAMPING = 2.0
"""Damping of every joint about the speed that was planned, N m s/rad."""
TOUCH = 0.003
"""A foot has landed when its lowest corner is that near to the ground, m."""


@dataclass
class Swing:
    """A step under way.

    Attributes:
        foot: Which.
        began: When, s.
        duration: How long, s.
        start: Pose of its sole when it began, (3,) m.
        yaw: Headings of it, from and to, rad.
        target: (2,) m.
        com: (2,) where the centre of mass was, m.
        rule: Who aims anew.
    """

    foot: int
    began: float
    duration: float
    start: Array
    yaw: tuple[float, float]
    target: Array
    com: Array
    rule: StepRule


class TorqueStepper:
    """The controller of a robot with torque joints.

    Args:
        joints: The robot's joints.
        body: Its whole-body control.
        stance: (n,) rad, the pose to stand in.
        rule: When and where to step; None balances without steps.
        stepping: How.

    Attributes:
        steps: Steps that were taken to prevent a fall.
        comforts: Comfort steps, which it does not take.
        phase: What it is at.
    """

    def __init__(
        self,
        joints: Joints,
        body: WholeBody,
        stance: Array,
        rule: StepRule | None,
        stepping: Stepping,
    ) -> None:
        self._joints, self._body, self.dynamics = joints, body, body.dynamics
        self._stance, self._rule, self._stepping = stance, rule, stepping
        self._reach = stepping.reach.reach()
        self.phase: Phase = "stand"
        self.steps = self.comforts = 0
        self._swing: Swing | None = None
        self._landed: int | None = None

    def reset(self, observation: Observation) -> None:
        """Begin to stand; the robot is in its stance."""
        self.dynamics.look(observation)
        self.phase, self.steps, self.comforts = "stand", 0, 0
        self._swing = self._landed = None
        self._height = float(self.dynamics.momenta.com[2])
        self._since = self._due = observation.time
        self._began = self.dynamics.momenta.com[:2].copy()
        self._plan: Plan | None = None

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the torques of now.

        Raises:
            StateMissingError: The observation has no base.
            WindupError: The optimisation found no answer.
        """
        now = observation.time
        self.dynamics.look(observation)
        if self._plan is None or now >= self._due - 0.5 * dt:
            self._due = max(self._due + PERIOD, now)
            self._decide(now)
            self._plan = self._body.plan(self._objectives(now))
            self._planned, self._speed = now, self.dynamics.velocity[6:].copy()
        command = JointCommand(np.zeros((5, len(self._joints))))
        command.position[:] = self._stance
        command.torque[:] = self._body.torque(self._plan)
        # A light foot runs away between two plans where it meets ground that was not expected.
        command.damping[:] = FOLLOW_DAMPING
        command.velocity[:] = self._speed + (now - self._planned) * self._plan.acceleration[6:]
        return command

    def _decide(self, now: float) -> None:
        """Go over to the next phase where it is time."""
        if self.phase == "swing":
            self._fly(now)
            return
        gone = now - self._since
        if self.phase == "land" and gone < self._stepping.dwell:
            return
        if self._rule is not None and self._falls(self._rule):
            self._begin(self._rule, now)
        elif self.phase == "land" and gone >= self._stepping.settle:
            self._landed = None
            self._enter("stand", now)

    def _enter(self, phase: Phase, now: float) -> None:
        self.phase, self._since = phase, now
        self._began = self.dynamics.momenta.com[:2].copy()

    def _falls(self, rule: StepRule) -> bool:
        """Return whether both feet as they stand cannot prevent a fall."""
        support = SupportRegion.hull(np.vstack([self.dynamics.ground(end) for end in (0, 1)]))
        return needs_step(trigger_point(rule, self.dynamics.momenta), support, self._stepping.slack)

    def _begin(self, rule: StepRule, now: float) -> None:
        """Choose a foot and lift it, if there is a place for it."""
        duration = self._stepping.duration
        placements = [self._placement(rule, foot, duration) for foot in (0, 1)]
        possible = [found for found in placements if found is not None]
        if not possible:
            return
        feet = np.array([end.position for end in self.dynamics.ends])
        chosen = choose(possible, feet, self._wanted, self._landed)
        self.steps += 1
        self._lift(chosen.foot, chosen.target, self._heading, duration, rule, now)

    def _lift(
        self, foot: int, target: Array, yaw: float, time: float, rule: StepRule, now: float
    ) -> None:
        pose = self.dynamics.ends[foot]
        com = self.dynamics.momenta.com[:2].copy()
        yaws = (yaw_of(pose.rotation), yaw)
        self._swing = Swing(foot, now, time, pose.position, yaws, target, com, rule)
        self._enter("swing", now)

    def _fly(self, now: float) -> None:
        """Aim anew, or land."""
        swing, stepping = self._flying, self._stepping
        part = (now - swing.began) / swing.duration
        if part < stepping.update:
            better = self._placement(swing.rule, swing.foot, swing.duration * (1.0 - part))
            if better is not None:
                swing.target = better.target
        lowest = float(self.dynamics.ground(swing.foot)[:, 2].min())
        if part > stepping.early and (lowest < TOUCH or part > 2.0):
            self._landed, self._swing = swing.foot, None
            self._enter("land", now)

    @property
    def _flying(self) -> Swing:
        assert self._swing is not None
        return self._swing

    def _placement(self, rule: StepRule, foot: int, left: float) -> Placement | None:
        """Return where `foot` should land in `left` s, or None where it cannot."""
        other = 1 - foot
        momenta = self.dynamics.momenta
        support = SupportRegion.hull(self.dynamics.ground(other))
        pivot = support.nearest(capture_point(momenta))
        wanted = landing_point(rule, momenta, pivot, left)
        # The point is where the ground should push: the middle of the sole, not below the ankle.
        middle = self._middle(foot) - self.dynamics.ends[foot].position[:2]
        self._wanted = pivot + self._stepping.gain * (wanted - pivot) - middle
        stance = self.dynamics.ends[other]
        region = self._reach.region(stance.position[:2], yaw_of(stance.rotation), 1 - 2 * foot)
        placed = place(foot, self._wanted, region)
        catch = place(foot, coming_point(momenta, pivot, left) - middle, region)
        if placed is None or catch is None:
            return None
        return replace(placed, uncaught=catch.missed)

    @property
    def _heading(self) -> float:
        """Heading of the base, rad."""
        return yaw_of(self.dynamics.base.rotation)

    def _middle(self, foot: int) -> Array:
        """Return (2,) m, the middle of a sole on the ground."""
        return np.asarray(self.dynamics.ground(foot)[:, :2].mean(axis=0))

    def _objectives(self, now: float) -> Objectives:
        """Return what the body should do now."""
        dynamics, swing = self.dynamics, self._swing
        stance = [foot for foot in (0, 1) if swing is None or foot != swing.foot]
        velocity = dynamics.velocity
        still = [-STILL_DAMPING * (dynamics.jacobian(foot) @ velocity) for foot in stance]
        posture = POSE_GAIN * (self._stance - dynamics.position) - POSE_DAMPING * velocity[6:]
        return Objectives(
            com=self._com_rate(now),
            angular=-SPIN_DAMPING * dynamics.momenta.angular,
            posture=posture,
            trunk=self._trunk_rate(),
            stance=stance,
            stance_rate=still,
            swing=None if swing is None else (swing.foot, self._swing_rate(swing, now)),
        )

    def _com_rate(self, now: float) -> Array:
        """Return the acceleration (3,) of the centre of mass (Eq. 10)."""
        body = self.dynamics.momenta
        aim, speed = self._com_aim(now), np.zeros(3)
        ahead = self._com_aim(now + PERIOD)
        speed[:2] = (ahead - aim) / PERIOD
        error = np.array([*aim, self._height]) - body.com
        return np.asarray(COM_GAIN * error + COM_DAMPING * (speed - body.velocity))

    def _com_aim(self, now: float) -> Array:
        """Return where (2,) m the centre of mass should be."""
        centre = 0.5 * (self._middle(0) + self._middle(1))
        if self._swing is not None:
            return self._com_swing(self._swing, now)
        part = min((now - self._since) / max(self._stepping.settle, PERIOD), 1.0)
        return np.asarray(self._began + gaussian_progress(part) * (centre - self._began))

    def _com_swing(self, swing: Swing, now: float) -> Array:
        """Return the point of the Bezier curve of section 5.2."""
        pivot = self._middle(1 - swing.foot)
        offset = self._middle(swing.foot) - self.dynamics.ends[swing.foot].position[:2]
        end = 0.5 * (pivot + swing.target + offset)
        return bezier(swing.com, pivot, end, (now - swing.began) / swing.duration)

    def _swing_rate(self, swing: Swing, now: float) -> Array:
        """Return the acceleration (6,) of the swing foot along its curve (section 5.1)."""
        pose = self.dynamics.ends[swing.foot]
        twist = self.dynamics.jacobian(swing.foot) @ self.dynamics.velocity
        at, yaw = self._swing_aim(swing, now)
        before, _ = self._swing_aim(swing, now - PERIOD)
        after, _ = self._swing_aim(swing, now + PERIOD)
        speed = (after - before) / (2.0 * PERIOD)
        force = (after - 2.0 * at + before) / PERIOD**2
        linear = force + SWING_GAIN * (at - pose.position) + SWING_DAMPING * (speed - twist[:3])
        turned = turn_between(pose.rotation, turn(yaw))
        return np.concatenate((linear, SWING_GAIN * turned - SWING_DAMPING * twist[3:]))

    def _swing_aim(self, swing: Swing, now: float) -> tuple[Array, float]:
        """Return where (3,) m the sole should be, and its heading, rad."""
        part = (now - swing.began) / swing.duration
        way = gaussian_progress(part)
        at = swing.start.copy()
        at[:2] += way * (swing.target - swing.start[:2])
        at[2] = (1.0 - way) * swing.start[2] + lift(part, self._stepping.lift)
        at[2] -= max(part - 1.0, 0.0) * self._stepping.lift  # and on, until it meets the ground
        left = (swing.yaw[1] - swing.yaw[0] + np.pi) % (2.0 * np.pi) - np.pi
        return at, swing.yaw[0] + way * left

    def _trunk_rate(self) -> Array:
        """Return the angular acceleration (3,) that turns the base upright, as the feet stand."""
        yaws = [yaw_of(end.rotation) for end in self.dynamics.ends]
        half = 0.5 * ((yaws[1] - yaws[0] + np.pi) % (2.0 * np.pi) - np.pi)
        base = self.dynamics.base.rotation
        error = base.T @ turn_between(base, turn(yaws[0] + half))  # seen from the base
        return POSE_GAIN * error - POSE_DAMPING * self.dynamics.velocity[3:6]
