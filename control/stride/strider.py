"""Walks and halts in any direction on position servos, planned with an inverted pendulum.

Kenwright 2012, section V. The plan is fixed to the stance foot: it moves with the measured place
of that foot. At each step the plan restarts from the measured feet; during the swing the landing
place is displaced by the predicted error of the capture point.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import atan2, cos, exp, sin, sqrt
from typing import Literal

import numpy as np

from windup.control.execution.leg_motion import PRESS, TAKE_OFF, Aim, LegMotion
from windup.control.execution.swing import gaussian_progress, lift
from windup.control.kinematics.limb_ik import LimbIk, Pose
from windup.control.kinematics.places import between, onto, seen_from
from windup.control.kinematics.robot_state import RobotState
from windup.control.kinematics.rotation import lying, turn, way_round
from windup.control.stride.pendulum import (
    PressureSegment,
    VelocityCommand,
    capture_on_way,
    future,
    next_place,
)
from windup.control.stride.stride_file import Stride
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.geometry.smooth_step import smooth_step
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import BlockNames, ControllerBlock
from windup.hal.publishing.run_state import RunState

Phase = Literal["stand", "shift", "swing", "land", "halt"]
PHASES: tuple[Phase, ...] = ("stand", "shift", "swing", "land", "halt")
AHEAD = 3
"""Horizon of the plan, steps; later ones have no noticeable effect."""
STEEPEST = 0.15
"""Maximum component of the measured ground normal along x and y (about the slope in rad)."""
MOST_BEHIND = 0.1
"""Maximum position lag that is made up for, m."""
FACING, AWAY = 0.1, 0.2
"""Heading errors below which a walk halts, and above which a standing robot turns, rad."""


class Strider(LegMotion):
    """Controller that walks at a commanded velocity.

    Args:
        joints: The robot's joints.
        state: The robot's state.
        limbs: Inverse kinematics of the two legs, in the order of the soles.
        stance: (n,) rad, the pose to start from; joints outside the legs keep it.
        orders: Returns the command for the time since the start, s; its headings are relative to
            the robot's heading at the start.
        how: Gains and times.

    Attributes:
        steps: Number of finished steps.
        phase: Present phase.
        published: Names of what `publish` fills in.
    """

    published = BlockNames(phases=PHASES)

    def __init__(
        self,
        joints: Joints,
        state: RobotState,
        limbs: Sequence[LimbIk],
        stance: Array,
        orders: Callable[[float], VelocityCommand],
        how: Stride,
    ) -> None:
        super().__init__(joints, state, limbs, stance, how)
        self.orders, self.how = orders, how
        self.steps = 0
        self.phase: Phase = "stand"

    def publish(self, block: ControllerBlock) -> None:
        """Publish the phase."""
        stands = self.phase == "stand"
        block.run_state = RunState.STANDING if stands else RunState.WALKING
        block.phase = PHASES.index(self.phase)

    def reset(self, observation: Observation) -> None:
        """Start standing at the measured place."""
        super().reset(observation)
        self.steps = 0
        self._feet = self.places.copy()
        middle = between(*self._feet)
        self._origin, self._wanted = observation.time, middle[:2].copy()
        self._facing = float(middle[2])
        self.pace = self.how.pace
        self._omega = sqrt(GRAVITY / (self.mass[2] - self.ground))
        self._com = self.mass[:2].copy()
        self._tall = float(self.pose.position[2]) - self.ground
        self._normal = np.array([0.0, 0.0, 1.0])
        self._foot, self._bears, self._part = 0, 1, 0.0
        self._yaws = (self._facing, self._facing)
        self._share, self._ending = 0.5, False
        self._pull = np.zeros(2)
        self._order = VelocityCommand()
        self._landing = self._target = self._left = self._feet[0]
        self._enter("stand", observation.time)

    def plan(self, now: float, dt: float) -> Aim:
        """Return the aim of this tick."""
        self._feel(dt)
        self._advance(now)
        if self.phase != "stand":
            self._wanted = self._wanted + dt * self._pull
        gone = now - self._began
        part = self._part = min(gone / self._time, 1.0)
        point = capture_on_way(self._ways, self._omega, gone)
        pace = self._omega * (point - self._com)
        there = self._planned(np.array([*self.mass[:2], 0.0]))[:2]
        self._com = self._com + dt * (pace + self.how.yielding * (there - self._com))
        if self.phase == "swing" and part < self.how.update:
            self._adjust(point)
        s = smooth_step(part) if self.phase == "swing" else 1.0
        yaw = self._yaws[0] + s * (self._yaws[1] - self._yaws[0])
        com = self._seen(np.array([*self._com, yaw]))
        rise = min((now - self._origin) / self.how.begin, 1.0)
        self._share = self._bearing(gone)
        return Aim(
            com=com[:2],
            speed=turn(com[2] - yaw)[:2, :2] @ pace,
            height=self._tall + rise * (self.how.height - self._tall),
            yaw=com[2],
            right_load=self._share,
            flying=self._foot if self.phase in ("swing", "land", "halt") else None,
            standing=max(1.0 - part / TAKE_OFF, 0.0) if self.phase == "swing" else part,
        )

    def sole(self, foot: int) -> Pose:
        """Return the desired pose of a sole on the ground: its place, aligned with the ground."""
        x, y, yaw = self.places[foot]
        return Pose(np.array([x, y, self.heights[foot]]), lying(self._normal, yaw))

    def flying(self, foot: int) -> Pose:
        """Return the desired pose of the swing foot's sole."""
        if self.phase != "swing":
            x, y, yaw = self._seen(self._landing)
            up = -PRESS
        else:
            ahead = min(self._part + self.how.lead / self.pace.single, 1.0)
            s = gaussian_progress(ahead)
            x, y, yaw = self._seen(self._left + s * (self._landing - self._left))
            up = lift(ahead, self.how.lift, self.how.early)
        stands = self.places[self._bears]
        slope = self._normal[:2] / self._normal[2]
        level = self.heights[self._bears] - float(slope @ (np.array([x, y]) - stands[:2]))
        return Pose(np.array([x, y, level + up]), lying(self._normal, yaw))

    def _asked(self, now: float) -> VelocityCommand:
        """Return the command of now in the plan's frame, with a velocity against position lag."""
        order = self.orders(now - self._origin)
        heading, face = self._facing + order.heading, self._facing + order.face
        wish = order.speed * np.array([cos(heading), sin(heading)])
        change = wish - self._pull
        change *= min(self.how.quicken / max(float(np.linalg.norm(change)), 1e-9), 1.0)
        self._pull = self._pull + change
        way = self._pull.copy()
        behind = self._wanted - between(*self.places)[:2]
        behind *= min(MOST_BEHIND / max(float(np.linalg.norm(behind)), 1e-9), 1.0)
        self._wanted = between(*self.places)[:2] + behind
        way += behind / self.how.keep
        return VelocityCommand(float(np.linalg.norm(way)), atan2(way[1], way[0]), face)

    def _advance(self, now: float) -> None:
        """Enter the next phase if it is due."""
        over = now - self._began >= self._time - 1e-9
        if self.phase == "stand":
            self._wanted, self._pull = between(*self.places)[:2], np.zeros(2)
            self._order = self._asked(now)
            if self._order.speed > 0.0 or abs(way_round(self.turned, self._order.face)) > AWAY:
                self._enter("shift", now)
        elif over and self.phase == "swing":
            self.steps += 1
            self._enter("halt" if self._ending else "land", now)
        elif over and self.phase == "halt":
            self._enter("stand", now)
        elif over:
            if self.phase == "land":
                self._foot = 1 - self._foot
            self._enter("swing", now)

    def _enter(self, phase: Phase, now: float) -> None:
        """Enter a phase, and replan from the measured feet."""
        self.phase, self._began = phase, now
        if phase == "shift":
            aside = way_round(self._facing, self._order.heading) * self._order.speed
            left = (aside or way_round(self._yaws[1], self._order.face)) > 0.0
            self._foot = 0 if left else 1
        if phase in ("stand", "shift", "swing"):
            self._com = self._seen(self._com)[:2]
            self._feet = self.places.copy()
            self._bears = 1 - self._foot
        else:
            self._feet[self._foot] = self._planned(self.places[self._foot])
        if phase == "swing":
            self._lift_off(now)
        self._time, self._ways = self._stretches()

    def _lift_off(self, now: float) -> None:
        """Set the landing place of the swing foot, and whether the walk ends there."""
        self._order = self._asked(now)
        stance = self._feet[self._bears]
        there = abs(way_round(stance[2], self._order.face)) < FACING
        self._ending = there and not self._pull.any()
        if self._ending:
            self._order = replace(self._order, speed=0.0)
        self._landing = self._target = next_place(stance, self._foot, self._order, self.pace)
        self._left = self._feet[self._foot].copy()
        self._left[2] = self._landing[2] + way_round(self._landing[2], self._left[2])
        towards = between(stance, self._landing)[2]
        self._yaws = (self._yaws[1], self._yaws[1] + way_round(self._yaws[1], towards))

    def _stretches(self) -> tuple[float, list[PressureSegment]]:
        """Return the duration of the present phase, s, and the CoP trajectory from its start."""
        pace, middle = self.pace, between(*self._feet)[:2]
        stance, other = self._feet[self._bears], self._feet[self._foot]
        if self.phase == "stand":
            return self.how.begin, [PressureSegment(middle, middle, self.how.begin)]
        if self.phase == "halt":
            return pace.period, [PressureSegment(stance[:2], middle, pace.period)]
        if self.phase == "land":
            first = PressureSegment(stance[:2], other[:2], pace.double)
            stance, foot = other, 1 - self._foot
            landing = next_place(stance, foot, self._order, pace)
        elif self.phase == "shift":
            first, foot = PressureSegment(middle, stance[:2], self.how.begin), self._foot
            landing = next_place(stance, foot, self._order, pace)
        else:
            return pace.single, self._swing_way()
        swing = PressureSegment(stance[:2], stance[:2], pace.single)
        ahead = future(stance, foot, landing, self._order, pace, AHEAD)
        return first.duration, [first, swing, *ahead]

    def _swing_way(self) -> list[PressureSegment]:
        """Return the CoP trajectory from the start of the present swing."""
        stance, steps = self._feet[self._bears], 0 if self._ending else AHEAD
        swing = PressureSegment(stance[:2], stance[:2], self.pace.single)
        ahead = future(stance, self._foot, self._landing, self._order, self.pace, steps)
        return [swing, *ahead]

    def _adjust(self, point: Array) -> None:
        """Displace the landing place by the capture point error predicted for touchdown."""
        now = self._planned(np.array([*self.mass[:2] + self.speed / self._omega, 0.0]))
        grows = exp(self._omega * self.pace.single * (1.0 - self._part))
        change = self.how.adjust * grows * (now[:2] - point)
        change = np.clip(change, -self.how.most, self.how.most)
        stance, side = self._feet[self._bears], 1 - 2 * self._foot
        there = seen_from(stance, self._target + np.array([*change, 0.0]))
        there[1] = side * max(side * there[1], self.pace.narrowest)
        self._landing = onto(stance, there)
        self._ways = self._swing_way()

    def _bearing(self, gone: float) -> float:
        """Return the desired share of the weight on the second foot."""
        if self.phase == "stand":
            return 0.5
        one, way = self._feet[0, :2], self._feet[1, :2] - self._feet[0, :2]
        along = (self._ways[0].pressure(gone) - one) @ way / (way @ way)
        return float(np.clip(along, 0.0, 1.0))

    def _feel(self, dt: float) -> None:
        """Update the ground's normal and height from the stance foot's sole."""
        if self.phase == "swing":
            up = self.state.feet[self._bears].rotation[:, 2]
            normal = self._normal + min(dt / self.how.feel, 1.0) * (up - self._normal)
            normal[:2] = np.clip(normal[:2], -STEEPEST, STEEPEST)
            self._normal = normal / np.linalg.norm(normal)
        one, other = self.heights
        self.ground = float((1.0 - self._share) * one + self._share * other)

    def _seen(self, place: Array) -> Array:
        """Return a place (2,) or (3,) of the plan in the world, by the measured stance foot."""
        full = place if len(place) == 3 else np.array([*place, 0.0])
        return onto(self.places[self._bears], seen_from(self._feet[self._bears], full))

    def _planned(self, place: Array) -> Array:
        """Return a place (3,) of the world in the plan's frame."""
        return onto(self._feet[self._bears], seen_from(self.places[self._bears], place))
