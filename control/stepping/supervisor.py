"""Supervisor that switches from a walk to the stepper for a push that the walk cannot absorb.

The stepper takes over in mid-step, steps, and comes to rest. Once the robot stands still, it moves
to the first pose of the walk, and the walk resumes.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from windup.control.kinematics.momenta import capture_point
from windup.control.kinematics.rotation import turn
from windup.control.limit_cycle.balancer import Balancer
from windup.control.motions.play import PoseHolder
from windup.control.stepping.capture_point_deviation import CapturePointDeviation
from windup.control.stepping.comfort import STILL
from windup.control.stepping.stepper import Stepper
from windup.control.stepping.stepping_file import CatchTable
from windup.hal.command import JointCommand
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import UNKNOWN, BlockNames, BlockPart, ControllerBlock
from windup.hal.publishing.run_state import RunState

Holder = Literal["walk", "step", "return"]
REST = 0.5
"""Minimum time of standing still before the walk resumes, s."""
LONGEST = 8.0
"""Time-out of standing still, s; a robot on its feet after this only rocks, and walks on."""


@dataclass
class Catch:
    """Record of one takeover by the stepper, whether or not it prevented the fall.

    Attributes:
        time: Time of the takeover, s.
        thrown: (2,) deviation of the capture point at the takeover, m: ahead, left.
        after: Number of steps walked before the takeover.
        steps: Number of steps that the stepper took.
        stood: Time at which the robot had come to rest, s, or None.
        back: Time at which the walk resumed, s, or None.
    """

    time: float
    thrown: Array
    after: int
    steps: int = 0
    stood: float | None = None
    back: float | None = None

    def record(self, walked: int) -> dict[str, Any]:
        """Return the record for a report, given the number of steps `walked` in total."""
        return {
            "handed_over_at": self.time,
            "thrown_m": self.thrown.tolist(),
            "steps": self.steps,
            "stood_at": self.stood,
            "handed_back_at": self.back,
            "walked_after": 0 if self.back is None else walked - self.after,
        }


class Supervisor:
    """Controller that walks, with a takeover by the stepper after a strong push.

    Args:
        walker: The walk.
        stepper: The stepper.
        start: (n,) first pose of the walk, rad.
        table: Criterion for a takeover, and the time of the return.
        period: Period of the walk, s, where the loop is faster because the stepper needs that: in
            between the last command of the walk stays. None is the period of the loop.

    Attributes:
        holder: The part in control: the walk, the stepper, or the return to the walk.
        catches: Records of all takeovers.
        state: The robot's state, which the walk and the stepper share.
    """

    def __init__(
        self,
        walker: Balancer,
        stepper: Stepper,
        start: Array,
        table: CatchTable,
        period: float | None = None,
    ) -> None:
        self.walker, self.stepper, self.table = walker, stepper, table
        self.state, self.period = walker.state, period
        self._back = PoseHolder(walker.joints, start, table.resume)
        self._throw = CapturePointDeviation()
        self.holder: Holder = "walk"
        self.catches: list[Catch] = []
        self._walk = BlockPart.of(walker)
        self._step = BlockPart.of(stepper, before=self._walk.names)

    @property
    def published(self) -> BlockNames:
        """Names of what the walk publishes, then of what the stepper does."""
        return self._step.all_names

    def publish(self, block: ControllerBlock) -> None:
        """Publish what the part in control does."""
        self._walk.publish(block)
        if self.holder == "step":
            self._step.publish(block)
        elif self.holder == "return":
            block.run_state = RunState.STANDING
            block.phase = block.reason = UNKNOWN

    def reset(self, observation: Observation) -> None:
        """Start walking.

        Raises:
            StateMissingError: The observation has no base state.
        """
        self.catches.clear()
        self.holder = "walk"
        self._calm = -np.inf
        self._throw.reset()
        self._wait = 0
        self.walker.reset(observation)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of the part in control; switch between the parts if that is due.

        Raises:
            StateMissingError: The observation has no base state.
        """
        if self.holder == "walk":
            if self._wait > 0:
                self._wait -= 1
                return self._walked
            thrown = self._thrown(observation, self._ticks(dt) * dt)
            if not self._lost(thrown, observation.time):
                return self._stride(observation, dt)
            self._catch(observation, thrown)
        if self.holder == "step":
            command = self.stepper.step(observation, dt)
            if not self._stands(observation.time):
                return command
            self.holder, self._since = "return", observation.time
            self._back.reset(observation)
        if observation.time - self._since < self.table.resume:
            return self._back.step(observation, dt)
        self._walk_on(observation)
        return self._stride(observation, dt)

    def _ticks(self, dt: float) -> int:
        """Return the number of ticks of the loop in one of the walk."""
        return 1 if self.period is None else max(round(self.period / dt), 1)

    def _stride(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of the walk, which stays until its next tick."""
        ticks = self._ticks(dt)
        self._wait = ticks - 1
        self._walked = self.walker.step(observation, ticks * dt)
        return self._walked

    def _thrown(self, observation: Observation, dt: float) -> Array:
        """Return the deviation (2,) m of the capture point from its reference (ahead, left)."""
        walker = self.walker
        if (moment := walker.moment) is None:
            return np.zeros(2)
        here = self.state.update(observation)
        away = capture_point(here.momenta) - here.feet_position[moment.stance, :2]
        heading = turn(walker.heading)[:2, :2].T
        tick = round(moment.elapsed / dt) - 1  # `elapsed` includes the tick of the entry
        return self._throw.detect(moment.state, tick, heading @ away)

    def _lost(self, thrown: Array, now: float) -> bool:
        """Return whether a recent push meets the criterion for a takeover."""
        if float(np.linalg.norm(thrown)) < self.table.calm:
            self._calm = now
        return self.table.meets(thrown) and now - self._calm <= self.table.fresh

    def _catch(self, observation: Observation, thrown: Array) -> None:
        """Hand over to the stepper."""
        self.holder = "step"
        self.catches.append(Catch(observation.time, thrown, self.walker.steps))
        self._moved = observation.time
        self.stepper.take(observation)

    def _stands(self, now: float) -> bool:
        """Return whether the robot has stood still for `REST`, or `LONGEST` has passed."""
        catch, stepper = self.catches[-1], self.stepper
        catch.steps = stepper.steps
        speed = float(np.linalg.norm(stepper.executor.feet.momenta.velocity[:2]))
        if stepper.phase not in ("stand", "comfort") or speed > STILL:
            self._moved = now
        still = now - self._moved >= REST or now - catch.time >= LONGEST
        if still:
            catch.stood = now
        return still

    def _walk_on(self, observation: Observation) -> None:
        self.holder = "walk"
        self.catches[-1].back = observation.time
        self._throw.reset()
        self.walker.resume(observation)
