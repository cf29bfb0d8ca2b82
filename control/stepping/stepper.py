"""Stands, and steps if a push requires it: the momentum supervisor on position servos.

The decision is that of Wu & Zordan 2010, section 4. The step is adapted to slow servos with
latency: the stance leg is held stiffly and the robot tips over it, the other foot is lifted as fast
as possible, and its target is updated early in the swing. Once the robot stands still, comfort
steps bring the feet back to the stance (Kenwright 2012, section IV).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot

import numpy as np
from shapely.geometry.base import BaseGeometry

from windup.control.footprints.keep_out import KeepOutRegions
from windup.control.footprints.swing import gaussian_progress
from windup.control.kinematics.momenta import capture_point
from windup.control.kinematics.rotation import facing, heading_between, turn
from windup.control.stepping.comfort import STILL, ComfortStep
from windup.control.stepping.footing import Footing
from windup.control.stepping.step_decision import (
    Placement,
    StepRule,
    choose,
    landing_point,
    needs_step,
    place,
    trigger_point,
)
from windup.control.stepping.stepper_block import STEPPER_NAMES, StepperPhase, publish_stepper
from windup.control.stepping.stepping_file import Stepping
from windup.hal.command import JointCommand
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import ControllerBlock

MOST_SHIFT = 0.06
"""Maximum displacement of the base against the capture point, m."""
MOST_PITCH = 0.8
"""Maximum additional pitch of the trunk, rad."""
TAKE = 0.6
"""Time after a takeover in which height, arms and head change to those of the stance, s."""


@dataclass
class Flight:
    """A step in its swing phase.

    Attributes:
        rule: The rule of its placement.
        foot: Index of the swing foot.
        began: Start time, s.
        start: (2,) place of the foot at the start, m.
        target: (2,) target of the foot, m.
        centre: (2,) desired position of the base at the start, m.
    """

    rule: StepRule
    foot: int
    began: float
    start: Array
    target: Array
    centre: Array


class Stepper:
    """Controller that stands in the stance and steps to prevent a fall.

    Args:
        joints: The robot's joints.
        footing: The robot's feet.
        stance: (n,) rad, the pose to stand in.
        rule: When and where to step; None balances without steps.
        stepping: Stepping parameters of the robot.
        no_step: Regions where no foot may come down.

    Attributes:
        steps: Number of steps taken to prevent a fall.
        comforts: Number of comfort steps.
        phase: Present phase.
        state: The robot's state.
        published: Names of what `publish` fills in.
    """

    published = STEPPER_NAMES

    def __init__(
        self,
        joints: Joints,
        footing: Footing,
        stance: Array,
        rule: StepRule | None,
        stepping: Stepping,
        no_step: KeepOutRegions | None = None,
    ) -> None:
        self.joints, self.footing, self.stance = joints, footing, stance
        self.state = footing.state
        self.rule, self.stepping = rule, stepping
        self.no_step = no_step or KeepOutRegions()
        self._reach = stepping.reach.reach()
        self.phase: StepperPhase = "stand"
        self.steps = self.comforts = 0

    def reset(self, observation: Observation) -> None:
        """Start standing; the robot must be in its stance."""
        self.phase = "stand"
        self.steps = self.comforts = 0
        self._hold = JointCommand.hold(self.joints, self.stance)
        self._landed = self._taken = -np.inf
        self._before, self._above = self.stance, self.footing.height
        self._moved = observation.time
        self.footing.update(observation)
        self._planted = self.footing.planted()
        self.footing.rounded = self.stepping.support == "capsule"
        self.no_step.begin(self.footing.feet, [self.footing.ground(foot) for foot in (0, 1)])

    def take(self, observation: Observation) -> None:
        """Take over during a walk, from any state; a foot in the air becomes the swing foot."""
        self.reset(observation)
        now, footing = observation.time, self.footing
        self._landed = self._taken = now
        self._before = observation.joints.position.copy()
        lowest = min(foot.position[2] for foot in footing.feet)
        self._above = float(footing.base.position[2] - lowest)
        if self.rule is not None and not all(footing.down):
            self._begin(self.rule, now, [footing.down.index(False)])

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of this tick.

        Raises:
            StateMissingError: The observation has no base.
        """
        now = observation.time
        self.footing.update(observation)
        self._decide(now)
        part = min((now - self._taken) / TAKE, 1.0)
        goals = self._before + part * (self.stance - self._before)
        self._height = self._above + part * (self.footing.height - self._above)
        self._pose(goals, now)
        return self._hold.with_position(goals)

    def publish(self, block: ControllerBlock) -> None:
        """Publish the phase, the capture point and the target of the swing foot."""
        target = self._flight.target if self.phase == "swing" else None
        publish_stepper(block, self.phase, self.footing.momenta, target)

    @property
    def stepping_foot(self) -> int:
        """Index of the swing foot of the present or last step."""
        return self._flight.foot

    def _decide(self, now: float) -> None:
        """Enter the next phase if it is due."""
        stepping = self.stepping
        if self.phase == "swing":
            self._fly(now)
            return
        if self.phase == "land" and now - self._landed < stepping.dwell:
            return
        if self.rule is not None and self._falls(self.rule):
            self._begin(self.rule, now)
        elif self.phase == "land":
            self.phase = "stand"
        elif self.phase == "comfort" and self._comfort.done(now):
            self._planted = self.footing.planted()
            # A step that was given up would fail again until something moves the robot.
            self.phase, self._moved = "stand", np.inf if self._comfort.given_up else now
        elif self.phase == "stand":
            self._settle(now)

    def _falls(self, rule: StepRule) -> bool:
        """Return whether the trigger point has left the support of both feet."""
        support = self.footing.support((0, 1))
        return needs_step(trigger_point(rule, self.footing.momenta), support, self.stepping.slack)

    def _fly(self, now: float) -> None:
        """Update the target of the swing foot early in the swing, or end the swing."""
        flight, stepping = self._flight, self.stepping
        part = (now - flight.began) / stepping.duration
        if part < stepping.update:
            left = stepping.duration * (1.0 - part)
            if (better := self._placement(flight.rule, flight.foot, left)) is not None:
                flight.target = better.target
        if part >= 1.0 or (part > stepping.early and self.footing.down[flight.foot]):
            self.phase, self._landed, self._moved = "land", now, now
            self._plant(1 - flight.foot)

    def _plant(self, floated: int) -> None:
        """Plant both feet at their measured places; with forbidden ground `floated` goes back.

        When the robot tips over it, the stance foot `floated` leaves the ground too. It comes down
        nearer to the other one than it stood, which shortens the comfort step, but that place is
        not checked against forbidden ground.
        """
        before, self._planted = self._planted, self.footing.planted()
        if self.no_step:
            stood = before.places[floated], before.yaws[floated]
            self._planted = self._planted.step(floated, *stood)

    def _begin(self, rule: StepRule, now: float, feet: Sequence[int] = (0, 1)) -> None:
        """Start a step with the best of `feet`, if any of them has an allowed place."""
        placements = [self._placement(rule, foot, self.stepping.duration) for foot in feet]
        possible = [found for found in placements if found is not None]
        if not possible:
            return
        footing = self.footing
        chosen = choose(possible, footing.places, self._wanted)
        start = footing.places[chosen.foot].copy()
        self._flight = Flight(rule, chosen.foot, now, start, chosen.target, self._centre(now))
        self._planted = footing.planted()
        self.phase, self.steps = "swing", self.steps + 1

    def _placement(self, rule: StepRule, foot: int, left: float) -> Placement | None:
        """Return the placement of `foot`, landing in `left` s, or None if no place is allowed."""
        footing, momenta = self.footing, self.footing.momenta
        pivot = footing.support((1 - foot,)).nearest(capture_point(momenta))
        wanted = landing_point(rule, momenta, pivot, left)
        self._wanted = pivot + self.stepping.gain * (wanted - pivot)
        region = self._reach.region(footing.places[1 - foot], footing.yaw, 1 - 2 * foot)
        return place(foot, self._wanted, region, self._holes(foot))

    def _holes(self, foot: int) -> list[BaseGeometry]:
        """Return the forbidden targets of a foot."""
        flying = self.phase == "swing"
        start = self._flight.start if flying else self.footing.places[foot]
        return self.no_step.holes(foot, self.footing.yaw, start)

    def _settle(self, now: float) -> None:
        """Start a comfort step if one is needed and the robot has stood still long enough."""
        footing, stepping = self.footing, self.stepping
        if hypot(*footing.momenta.velocity[:2]) > STILL:
            self._moved = now
        if now - self._moved < stepping.patience:
            return
        self._moved = now  # if no step is needed, check again after the same time
        comfort = ComfortStep(footing, now, stepping)
        foot, yaw = comfort.foot, footing.yaw
        free = self.no_step.allows(foot, yaw, footing.places[foot], comfort.target)
        if comfort.needed and free:
            self._comfort = comfort
            self.phase, self.comforts = "comfort", self.comforts + 1

    def _pose(self, goals: Array, now: float) -> None:
        """Set the goals of the legs' joints in `goals` (n,), rad."""
        footing = self.footing
        if self.phase == "comfort":
            self._comfort.pose(goals, now)
            return
        if self.phase == "swing":
            self._swing(goals, now)
            return
        against = self._against((footing.places[0] + footing.places[1]) / 2.0)
        place = self._centre(now) - against
        base = footing.upright(place, self._heading(now), height=self._height)
        for foot in (0, 1):
            footing.keep(goals, foot, self._planted, base)

    def _swing(self, goals: Array, now: float) -> None:
        """Set the goals of the swing: one leg stiff, the other foot at its place in `lead` s."""
        footing, stepping, flight = self.footing, self.stepping, self._flight
        gone = now - flight.began
        way = gaussian_progress((gone + stepping.lead) / stepping.duration)
        at = np.zeros(3)
        at[:2] = flight.start + way * (flight.target - flight.start)
        # The height is a step function: the servos are too slow for a smooth curve.
        at[2] = stepping.lift if gone < stepping.up * stepping.duration else 0.0
        # The trunk turns until then, and the foot should have its heading.
        seen = footing.ahead(stepping.lead)
        footing.put(goals, flight.foot, at, facing(seen.rotation), seen)
        pivot = footing.places[1 - flight.foot]
        ahead = float(turn(footing.yaw)[:2, 0] @ (capture_point(footing.momenta) - pivot))
        pitch = np.clip(-stepping.trunk * ahead, -MOST_PITCH, MOST_PITCH)
        place = flight.centre - self._against(pivot)
        base = footing.upright(place, footing.yaw, float(pitch), self._height)
        footing.keep(goals, 1 - flight.foot, self._planted, base)

    def _centre(self, now: float) -> Array:
        """Return the desired position (2,) m of the base; it returns over the feet after a step."""
        here = self.footing.base.position[:2]
        return here + self._back(now) * (self.footing.home(self._planted) - here)

    def _heading(self, now: float) -> float:
        """Return the desired heading of the base, rad; it returns to the feet's after a step."""
        return heading_between(self.footing.yaw, self._planted.front, self._back(now))

    def _back(self, now: float) -> float:
        """Return the progress of the base's return over the feet after a step, 0 to 1."""
        return min((now - self._landed) / max(self.stepping.settle, 1e-6), 1.0)

    def _against(self, middle: Array) -> Array:
        """Return the displacement (2,) m to subtract from the base against the capture point."""
        away = self.stepping.balance * (capture_point(self.footing.momenta) - middle)
        return np.minimum(np.maximum(away, -MOST_SHIFT), MOST_SHIFT)
