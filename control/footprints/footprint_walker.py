"""Walks footprints, quasi-statically: first the weight shifts, then a foot swings.

Wu & Zordan 2010, sections 4 and 5, with given footprints: every step begins and ends at rest. Each
phase is planned from the measured places of the feet, so that errors do not accumulate.
"""

from collections.abc import Sequence

import numpy as np

from windup.control.execution.executor import WalkExecutor
from windup.control.execution.motion import (
    Planted,
    Shift,
    Swing,
    WalkMotion,
    WalkPhase,
    shift_time,
)
from windup.control.execution.swing import smooth_progress
from windup.control.footprints.directed_file import Directed
from windup.control.footprints.footprints import Footprint
from windup.control.kinematics.places import between, onto, seen_from
from windup.control.kinematics.rotation import way_round
from windup.hal.command import JointCommand
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import BlockNames, ControllerBlock
from windup.hal.publishing.run_state import RunState

PHASES: tuple[WalkPhase, ...] = ("rest", "shift", "swing", "land")
LATE = 2.0
"""Time-out of a swing, in multiples of its duration; it then ends even without contact."""


class FootprintWalker:
    """Controller that walks a list of footprints and ends with the weight between the feet.

    Args:
        executor: Realises the motions.
        prints: Footprints to walk, in order.
        how: Times and tolerances.

    Attributes:
        finished: All steps are done and the weight is between the feet.
        landed: Number of steps whose foot has come down and bears load.
        stood: Number of steps after which the following weight shift has ended.
        motion: What the robot should do.
        state: The robot's state.
        published: Names of what `publish` fills in.
    """

    motion: WalkMotion
    published = BlockNames(phases=PHASES)

    def __init__(self, executor: WalkExecutor, prints: Sequence[Footprint], how: Directed) -> None:
        self.executor, self.prints, self.how = executor, prints, how
        self.state = executor.state
        self.finished, self.landed, self.stood = False, 0, 0

    @property
    def places(self) -> Array:
        """Measured places (2, 3) of the feet: x m, y m, yaw rad."""
        return self.executor.places

    def publish(self, block: ControllerBlock) -> None:
        """Publish the phase."""
        block.run_state = RunState.STANDING if self.finished else RunState.STEPPING
        block.phase = PHASES.index(self.motion.phase)

    def reset(self, observation: Observation) -> None:
        """Start from the measured places of the feet."""
        executor, now = self.executor, observation.time
        executor.reset(observation)
        places, com = executor.places, executor.com.copy()
        self._origin = between(*places)
        self.finished, self.landed, self.stood = False, 0, 0
        self._last = now
        yaw, height = executor.yaw, executor.height
        self.motion = WalkMotion(
            planted=_planted(places),
            shift=Shift(com, com, now, 1.0, smooth_progress, smooth=True),
            yaw=(yaw, yaw),
            height=(height, height),
            apart=seen_from(*places),
        )
        self._enter("rest", now)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of this tick.

        Raises:
            StateMissingError: The observation has no base.
            WindupError: The optimisation of whole-body control found no solution.
        """
        now = observation.time
        self.executor.observe(observation)
        if self.executor.due(now, dt):
            self._advance(now)
        self._last = now
        return self.executor.realise(self.motion, now, dt)

    def _advance(self, now: float) -> None:
        """Enter the next phase if the present one is over."""
        motion, shift = self.motion, self.motion.shift
        if self.executor.follows_feet:
            shift.goal = self._weight_goal(motion)
            if motion.phase in ("swing", "land"):
                shift.start = shift.goal
        gone = now - shift.began
        if gone < shift.seconds - 1e-9 or self.finished:
            return
        if motion.phase == "swing":
            if self.executor.touches(motion.foot) or gone >= LATE * shift.seconds:
                self._enter("land", now)
            return
        if motion.phase == "land":
            self.landed += 1
            self._enter("shift" if self.landed < len(self.prints) else "rest", now)
            return
        self.stood = self.landed
        if self._calm() or gone > self.how.patience * shift.seconds:
            self._rested(now)

    def _rested(self, now: float) -> None:
        """Enter the next phase after a completed weight shift, or finish."""
        if self.motion.phase == "shift":
            self._enter("swing", now)
        elif self.landed < len(self.prints):
            self._enter("shift", now)
        else:
            self.finished = True

    def _calm(self) -> bool:
        """Return True if the CoM is at its goal and at rest, within the tolerances."""
        executor = self.executor
        away = np.hypot(*(executor.com - self.motion.shift.goal))
        return bool(away < self.how.near and np.hypot(*executor.com_velocity) < self.how.quiet)

    def _enter(self, phase: WalkPhase, now: float) -> None:
        """Enter a phase, from what was desired in the last tick to the phase's goal."""
        before, places = self.motion, self.executor.places
        s = smooth_progress(before.shift.part(self._last))
        yaw, height, load = (_at(pair, s) for pair in (_pair(before), before.height, before.load))
        self.motion = motion = WalkMotion(
            planted=_planted(places),
            shift=before.shift,
            phase=phase,
            foot=self.prints[self.landed].foot if phase == "shift" else before.foot,
            left=before.left,
            target=before.target,
            apart=before.apart,
        )
        if phase == "swing":
            self._fix(motion, places)
        elif phase == "land":
            motion.apart = _apart(motion.foot, places[1 - motion.foot], motion.target)
        goal, toward = self._weight_goal(motion), self._yaw_goal(motion, yaw, places)
        start = self._weight_start(before, phase, goal)
        seconds = self._seconds(phase, float(np.hypot(*(goal - start))))
        motion.shift = Shift(start, goal, now, seconds, smooth_progress, smooth=True)
        motion.yaw, motion.height = (yaw, toward), (height, self.how.height)
        motion.load = load, 0.5 if phase == "rest" else float(1 - motion.foot)
        if phase == "swing":
            motion.swing = self._swing(motion, places, now)

    def _fix(self, motion: WalkMotion, places: Array) -> None:
        """Set the start and target place of the swing foot, relative to the stance foot."""
        wanted, stance = self.prints[self.landed], places[1 - motion.foot]
        motion.left, motion.target = seen_from(stance, places[motion.foot]), wanted.place
        if wanted.frame == "start":
            motion.target = seen_from(stance, onto(self._origin, wanted.place))

    def _weight_goal(self, motion: WalkMotion) -> Array:
        """Return where the CoM (2,) is to be: between both feet or over the stance foot, m."""
        middle = self.executor.middle
        if motion.phase == "rest":
            return np.asarray(0.5 * (middle(0) + middle(1)))
        return middle(1 - motion.foot).copy()

    def _weight_start(self, before: WalkMotion, phase: WalkPhase, goal: Array) -> Array:
        """Return where the path (2,) of the CoM to `goal` (2,) begins, m."""
        if not self.executor.follows_feet:
            return before.shift.at(self._last)
        return self.executor.com.copy() if phase in ("rest", "shift") else goal

    def _yaw_goal(self, motion: WalkMotion, yaw: float, places: Array) -> float:
        """Return the heading of the base at the end of a phase that begins at `yaw`, rad."""
        if motion.phase == "rest":
            return yaw + way_round(yaw, between(*places)[2])
        if motion.phase == "swing":
            stance = places[1 - motion.foot]
            return yaw + way_round(yaw, between(stance, onto(stance, motion.target))[2])
        return yaw

    def _seconds(self, phase: WalkPhase, far: float) -> float:
        """Return the duration of a phase in which the weight moves by `far` m, s."""
        if phase == "swing":
            return self.prints[self.landed].duration or self.how.swing
        return self.how.land if phase == "land" else shift_time(far, self.how.shift, self.how.pace)

    def _swing(self, motion: WalkMotion, places: Array, now: float) -> Swing:
        """Return the swing of the foot to its footprint, in the world."""
        target = onto(places[1 - motion.foot], motion.target)
        yaws = float(places[motion.foot, 2]), float(target[2])
        start = self.executor.lift_off(motion.foot, motion.planted)
        duration, anchor = motion.shift.seconds, motion.shift.start
        return Swing(motion.foot, now, duration, start, target[:2], yaws, self.how.lift, anchor)


def _planted(places: Array) -> Planted:
    """Return the places (2, 3), x m, y m, yaw rad, as places at which the feet stay."""
    return Planted(np.column_stack([places[:, :2], np.zeros(2)]), places[:, 2].copy())


def _apart(foot: int, stance: Array, target: Array) -> Array:
    """Return the place (3,) of the second foot relative to the first, after a step of `foot`."""
    there = onto(stance, target)
    return seen_from(there, stance) if foot == 0 else seen_from(stance, there)


def _pair(motion: WalkMotion) -> tuple[float, float]:
    assert motion.yaw is not None, "a walk has headings"
    return motion.yaw


def _at(pair: tuple[float, float], s: float) -> float:
    return pair[0] + s * (pair[1] - pair[0])
