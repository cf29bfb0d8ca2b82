"""Stands, and steps if a push requires it, with torques from whole-body control.

Wu & Zordan 2010, section 4: the momentum supervisor decides when and where to step.
"""

from dataclasses import replace
from math import hypot
from typing import Literal

import numpy as np

from windup.control.footprints.keep_out import KeepOutRegions
from windup.control.footprints.swing import bezier, gaussian_progress
from windup.control.footprints.torque_motion import PERIOD, Swing, TorqueMotion
from windup.control.kinematics.momenta import capture_point
from windup.control.kinematics.rotation import yaw_of
from windup.control.kinematics.support import SupportRegion
from windup.control.stepping.comfort import STILL
from windup.control.stepping.step_decision import (
    Placement,
    StepRule,
    choose,
    coming_point,
    landing_point,
    needs_step,
    place,
    trigger_point,
)
from windup.control.stepping.stepping_file import Stepping
from windup.control.stepping.torque_comfort import TorqueComfort
from windup.control.whole_body.whole_body import WholeBody
from windup.hal.command import JointCommand
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

Phase = Literal["stand", "swing", "land", "comfort"]
TOUCH = 0.003
"""Height of a foot's lowest corner below which it has landed, m."""


class TorqueStepper(TorqueMotion):
    """Controller that stands in the stance and steps to prevent a fall, with joint torques.

    Args:
        joints: The robot's joints.
        body: The robot's whole-body control.
        stance: (n,) rad, the pose to stand in.
        rule: When and where to step; None balances without steps.
        stepping: Stepping parameters of the robot.
        no_step: Regions where no foot may come down.
        comfort: Comfort steps; None takes none.

    Attributes:
        steps: Number of steps taken to prevent a fall.
        comforts: Number of comfort steps.
        phase: Present phase.
    """

    def __init__(
        self,
        joints: Joints,
        body: WholeBody,
        stance: Array,
        rule: StepRule | None,
        stepping: Stepping,
        no_step: KeepOutRegions | None = None,
        comfort: TorqueComfort | None = None,
    ) -> None:
        self.no_step, self._comfort = no_step or KeepOutRegions(), comfort
        super().__init__(joints, body, stance, stepping.lift)
        self._rule, self._stepping = rule, stepping
        self._reach = stepping.reach.reach()
        self.phase: Phase = "stand"
        self.steps = self.comforts = 0
        self._landed: int | None = None

    def reset(self, observation: Observation) -> None:
        """Start standing; the robot must be in its stance."""
        super().reset(observation)
        self.phase, self.steps, self.comforts, self._landed = "stand", 0, 0, None
        self.no_step.begin(self.dynamics.ends, [self.dynamics.ground(foot) for foot in (0, 1)])
        self._since, self._began = observation.time, self.dynamics.momenta.com[:2].copy()
        self._moved = observation.time
        if self._comfort is not None:
            self._comfort.reset(self.places)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of this tick; see `TorqueMotion.step`.

        Raises:
            StateMissingError: The observation has no base.
            WindupError: The optimisation found no solution.
        """
        now = observation.time
        if self.phase == "comfort":
            command = self._walk.step(observation, dt)
            if self._walk.finished or (self._rule is not None and self._falls(self._rule)):
                # A step that was given up would fail again until something moves the robot.
                self._moved = np.inf if self._walk.given_up else now
                self._due, self._plan = now, None
                self._enter("stand", now)
            return command
        command = super().step(observation, dt)
        if self.phase == "stand" and self._comfort is not None:
            self._settle(self._comfort, observation)
        return command

    def _settle(self, comfort: TorqueComfort, observation: Observation) -> None:
        """Start a comfort step if one is needed and the robot has stood still long enough."""
        now = observation.time
        if hypot(*self.dynamics.momenta.velocity[:2]) > STILL:
            self._moved = now
        if now - self._moved < self._stepping.patience:
            return
        self._moved = now  # if no step is needed, check again after the same time
        if (missing := comfort.needed(self.places, self.no_step.allows)) is not None:
            self._walk = comfort.walk(missing)
            self._walk.reset(observation)
            self.phase, self.comforts = "comfort", self.comforts + 1

    def _decide(self, now: float) -> None:
        """Enter the next phase if it is due."""
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
        """Return whether the trigger point has left the support of both feet."""
        soles = [self.dynamics.ground(end) for end in (0, 1)]
        rounded = self._stepping.support == "capsule"
        support = SupportRegion.rounded(soles) if rounded else SupportRegion.hull(np.vstack(soles))
        return needs_step(trigger_point(rule, self.dynamics.momenta), support, self._stepping.slack)

    def _begin(self, rule: StepRule, now: float) -> None:
        """Start a step with the better foot, if any foot has an allowed place."""
        duration = self._stepping.duration
        placements = [self._placement(rule, foot, duration) for foot in (0, 1)]
        possible = [found for found in placements if found is not None]
        if not possible:
            return
        feet = np.array([end.position for end in self.dynamics.ends])
        chosen = choose(possible, feet, self._wanted, self._landed)
        self.steps += 1
        self._lift(chosen.foot, chosen.target, self._heading, duration, now)
        self._enter("swing", now)

    def _fly(self, now: float) -> None:
        """Update the target of the swing foot early in the swing, or end the swing."""
        swing, stepping = self._flying, self._stepping
        part = (now - swing.began) / swing.duration
        if self._rule is not None and part < stepping.update:
            better = self._placement(self._rule, swing.foot, swing.duration * (1.0 - part))
            if better is not None:
                swing.target = better.target
        lowest = float(self.dynamics.ground(swing.foot)[:, 2].min())
        if part > stepping.early and (lowest < TOUCH or part > 2.0):
            self._landed, self._swing = swing.foot, None
            self._enter("land", now)

    def _placement(self, rule: StepRule, foot: int, left: float) -> Placement | None:
        """Return the placement of `foot`, landing in `left` s, or None if no place is allowed."""
        other = 1 - foot
        momenta = self.dynamics.momenta
        support = SupportRegion.hull(self.dynamics.ground(other))
        pivot = support.nearest(capture_point(momenta))
        wanted = landing_point(rule, momenta, pivot, left)
        # The landing point is a centre of pressure: the sole's centre, not the end's site.
        middle = self._middle(foot) - self.dynamics.ends[foot].position[:2]
        self._wanted = pivot + self._stepping.gain * (wanted - pivot) - middle
        stance = self.dynamics.ends[other]
        region = self._reach.region(stance.position[:2], yaw_of(stance.rotation), 1 - 2 * foot)
        start = self._swing.start if self._swing else self.dynamics.ends[foot].position
        holes = self.no_step.holes(foot, self._heading, start[:2])
        placed = place(foot, self._wanted, region, holes)
        catch = place(foot, coming_point(momenta, pivot, left) - middle, region, holes)
        if placed is None or catch is None:
            return None
        return replace(placed, uncaught=catch.missed)

    @property
    def _heading(self) -> float:
        """Heading of the base, rad."""
        return yaw_of(self.dynamics.base.rotation)

    def _com_aim(self, now: float) -> Array:
        """Return the desired position (2,) of the centre of mass, m."""
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
