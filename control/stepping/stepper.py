"""Stands, and steps if a push requires it: the momentum supervisor of Wu & Zordan 2010, section 4.

It decides when to step, with which foot, where to and in which time; an executor realises that
with position servos or with torques. Once the robot stands still, comfort steps bring the feet
back to the stance (Kenwright 2012, section IV).
"""

from collections.abc import Sequence
from dataclasses import replace
from math import hypot

import numpy as np

from windup.control.execution.executor import StepExecutor
from windup.control.execution.motion import Motion, Planted, Shift, Swing
from windup.control.execution.swing import gaussian_progress
from windup.control.footprints.keep_out import KeepOutRegions
from windup.control.kinematics.momenta import capture_point
from windup.control.stepping.comfort import STILL, ComfortStep
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
from windup.control.stepping.stepper_block import STEPPER_NAMES, StepperPhase, publish_stepper
from windup.control.stepping.stepping_file import Stepping
from windup.hal.command import JointCommand
from windup.hal.geometry.smooth_step import smooth_step
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import ControllerBlock


class Stepper:
    """Controller that stands in the stance and steps to prevent a fall.

    Args:
        executor: Realises the motions.
        rule: When and where to step; None balances without steps.
        stepping: Stepping parameters of the robot.
        no_step: Regions where no foot may come down.

    Attributes:
        steps: Number of steps taken to prevent a fall.
        comforts: Number of comfort steps.
        phase: Present phase.
        state: The robot's state.
        motion: What the robot should do, but for comfort steps.
        published: Names of what `publish` fills in.
    """

    motion: Motion
    published = STEPPER_NAMES

    def __init__(
        self,
        executor: StepExecutor,
        rule: StepRule | None,
        stepping: Stepping,
        no_step: KeepOutRegions | None = None,
    ) -> None:
        self.executor, self.rule, self.stepping = executor, rule, stepping
        self.state = executor.state
        self.no_step = no_step or KeepOutRegions()
        self._reach = stepping.reach.reach()
        self.phase: StepperPhase = "stand"
        self.steps = self.comforts = 0
        self._flight: Swing | None = None

    def reset(self, observation: Observation) -> None:
        """Start standing; the robot must be in its stance."""
        self.executor.reset(observation)
        self._start(observation.time, -np.inf)

    def take(self, observation: Observation) -> None:
        """Take over during a walk, from any state; a foot in the air becomes the swing foot."""
        now = observation.time
        self.executor.take(observation)
        self._start(now, now)
        feet = self.executor.feet
        if self.rule is not None and not all(feet.down):
            self._begin(self.rule, now, [feet.down.index(False)])

    def _start(self, now: float, landed: float) -> None:
        """Start standing on the feet as measured."""
        self.phase, self._flight = "stand", None
        self.steps = self.comforts = 0
        self._moved, self._returning = now, False
        feet = self.executor.feet
        feet.rounded = self.stepping.support == "capsule"
        self.no_step.begin(feet.feet, [feet.ground(foot) for foot in (0, 1)])
        planted = feet.planted()
        self.motion = Motion(planted, self._return(planted, now), landed=landed)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of this tick.

        Raises:
            StateMissingError: The observation has no base.
            WindupError: The optimisation of whole-body control found no solution.
        """
        now = observation.time
        self.executor.observe(observation)
        if self.executor.due(now, dt):
            self._decide(now)
        motion = self._comfort.motion if self.phase == "comfort" else self.motion
        return self.executor.realise(motion, now, dt)

    def publish(self, block: ControllerBlock) -> None:
        """Publish the phase, the capture point and the target of the swing foot."""
        swing = self.motion.swing
        target = None if swing is None else swing.target
        publish_stepper(block, self.phase, self.executor.feet.momenta, target)

    @property
    def stepping_foot(self) -> int:
        """Index of the swing foot of the present or last step."""
        assert self._flight is not None, "it has stepped"
        return self._flight.foot

    def _decide(self, now: float) -> None:
        """Enter the next phase if it is due."""
        if self.phase == "swing" and self._flight is not None:
            self._fly(self._flight, now)
            return
        self.motion.shift.goal = self.executor.home(self.motion.planted)
        if self.phase == "land" and now - self.motion.landed < self.stepping.dwell:
            return
        if self.rule is not None and self._falls(self.rule):
            self._begin(self.rule, now)
        elif self.phase == "land":
            self.phase = "stand"
        elif self.phase == "comfort":
            self._go_on(self._comfort, now)
        else:
            if self._returning and now - self.motion.landed >= self.stepping.settle:
                self._returning = False
                self.motion.shift = self._return(self.motion.planted, now)
            self._settle(now)

    def _falls(self, rule: StepRule) -> bool:
        """Return whether the trigger point has left the support of both feet."""
        feet = self.executor.feet
        point = trigger_point(rule, feet.momenta)
        return needs_step(point, feet.support((0, 1)), self.stepping.slack)

    def _fly(self, swing: Swing, now: float) -> None:
        """Update the target of the swing foot early in the swing, or end the swing."""
        stepping, part = self.stepping, swing.part(now)
        if part < stepping.update and self.rule is not None:
            left = stepping.duration * (1.0 - part)
            if (better := self._placement(self.rule, swing.foot, left)) is not None:
                swing.target = better.target
        touched = self.executor.feet.down[swing.foot]
        if part >= stepping.late or (part > stepping.early and touched):
            self.phase, self._moved = "land", now
            self.motion.swing, self.motion.landed = None, now
            self._plant(1 - swing.foot)
            self._returning = True
            self.motion.shift = self._return(self.motion.planted, now)
        else:
            self.motion.shift = self._arc(swing)

    def _plant(self, floated: int) -> None:
        """Plant both feet at their measured places; with forbidden ground `floated` goes back.

        When the robot tips over it, the stance foot `floated` leaves the ground too. It comes down
        nearer to the other one than it stood, which shortens the comfort step, but that place is
        not checked against forbidden ground.
        """
        before, after = self.motion.planted, self.executor.feet.planted()
        if self.no_step:
            after = after.step(floated, before.places[floated], before.yaws[floated])
        self.motion.planted = after

    def _begin(self, rule: StepRule, now: float, feet: Sequence[int] = (0, 1)) -> None:
        """Start a step with the best of `feet`, if any of them has an allowed place."""
        placements = [self._placement(rule, foot, self.stepping.duration) for foot in feet]
        possible = [found for found in placements if found is not None]
        if not possible:
            return
        measured, motion, duration = self.executor.feet, self.motion, self.stepping.duration
        chosen = choose(possible, measured.places, self._wanted, self._landed_foot(now))
        anchor = self.executor.anchor(motion, now)
        motion.planted = measured.planted()
        start = self.executor.lift_off(chosen.foot, motion.planted)
        yaws = float(motion.planted.yaws[chosen.foot]), measured.yaw
        swing = Swing(
            chosen.foot, now, duration, start, chosen.target, yaws, self.stepping.lift, anchor
        )
        self._flight = motion.swing = swing
        motion.shift = self._arc(swing)
        self.phase, self.steps = "swing", self.steps + 1

    def _landed_foot(self, now: float) -> int | None:
        """Return the foot that has just landed, where that counts in the choice of the next."""
        recent = now - self.motion.landed < self.stepping.settle
        if self.stepping.foot == "landing" or self._flight is None or not recent:
            return None
        return self._flight.foot

    def _placement(self, rule: StepRule, foot: int, left: float) -> Placement | None:
        """Return the placement of `foot`, landing in `left` s, or None if no place is allowed."""
        feet, momenta = self.executor.feet, self.executor.feet.momenta
        pivot = feet.support((1 - foot,)).nearest(capture_point(momenta))
        wanted = landing_point(rule, momenta, pivot, left)
        # The landing point is a centre of pressure: the sole's middle, not its site.
        middle = feet.middle(foot) - feet.places[foot]
        self._wanted = pivot + self.stepping.gain * (wanted - pivot) - middle
        yaw = feet.reach_yaw(1 - foot)
        region = self._reach.region(feet.places[1 - foot], yaw, 1 - 2 * foot)
        start = self._flight.start if self.phase == "swing" and self._flight else feet.places[foot]
        holes = self.no_step.holes(foot, feet.yaw, start[:2])
        placed = place(foot, self._wanted, region, holes)
        if placed is None or self.stepping.foot == "landing":
            return placed
        catch = place(foot, coming_point(momenta, pivot, left) - middle, region, holes)
        assert catch is not None, "the region is the same"
        return replace(placed, uncaught=catch.missed)

    def _settle(self, now: float) -> None:
        """Start a comfort step if one is needed and the robot has stood still long enough."""
        feet, stepping = self.executor.feet, self.stepping
        if hypot(*feet.momenta.velocity[:2]) > STILL:
            self._moved = now
        if now - self._moved < stepping.patience:
            return
        self._moved = now  # if no step is needed, check again after the same time
        comfort = ComfortStep(self.executor, now, stepping)
        foot = comfort.foot
        free = self.no_step.allows(foot, feet.yaw, feet.places[foot], comfort.target)
        if comfort.needed and free:
            self._comfort = comfort
            self.phase, self.comforts = "comfort", self.comforts + 1
            comfort.advance(now)

    def _go_on(self, comfort: ComfortStep, now: float) -> None:
        """Continue a comfort step, or end it."""
        if not comfort.done(now):
            comfort.advance(now)
            return
        self.motion.planted = planted = self.executor.feet.planted()
        # A step that was given up would fail again until something moves the robot.
        self.phase, self._moved = "stand", np.inf if comfort.given_up else now
        self.motion.shift = self._return(planted, now)

    def _return(self, planted: Planted, now: float) -> Shift:
        """Return the path of the weight back over the feet."""
        start, goal = self.executor.weight, self.executor.home(planted)
        seconds = max(self.stepping.settle, 1e-6)
        return Shift(start, goal, now, seconds, gaussian_progress)

    def _arc(self, swing: Swing) -> Shift:
        """Return the path of the weight in a swing: the Bezier curve of section 5.2."""
        feet = self.executor.feet
        pivot, offset = feet.middle(1 - swing.foot), feet.middle(swing.foot)
        end: Array = 0.5 * (pivot + swing.target + offset - feet.places[swing.foot])
        return Shift(swing.anchor, end, swing.began, swing.duration, smooth_step, via=pivot)
