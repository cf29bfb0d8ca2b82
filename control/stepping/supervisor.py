"""Who has the robot: the walk, or the stepper while a push is more than the walk absorbs.

The stepper takes over in mid-step from wherever the robot is, steps, and halts. Once it stands
still, the robot goes to the pose that the walk begins with, and walks on.
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

Holder = Literal["walk", "step", "return"]
REST = 0.5
"""How long the robot has stood still before it goes on, s."""
CALM = 0.02
"""A walk that is thrown less than this is on its way, m."""
FRESH = 0.12
"""From the last moment on its way to the hand-over at most, s; later on the walk does better."""
LONGEST = 8.0
"""A robot that is still on its feet after this goes on, s; it only rocks."""
RETURN = 1.0
"""Time to come to the pose that the walk begins with, s."""


@dataclass
class Catch:
    """One push that the stepper caught, or did not.

    Attributes:
        time: When the stepper took over, s.
        thrown: (2,) how far the capture point was off its usual way then, m: ahead, to the left.
        after: Steps that had been walked by then.
        steps: Steps that it took.
        stood: When the robot had come to rest, s; None as long as it has not.
        back: When the walk went on, s; None as long as it has not.
    """

    time: float
    thrown: Array
    after: int
    steps: int = 0
    stood: float | None = None
    back: float | None = None

    def record(self, walked: int) -> dict[str, Any]:
        """Return it as numbers for a report, for a walk of `walked` steps in all."""
        return {
            "handed_over_at": self.time,
            "thrown_m": self.thrown.tolist(),
            "steps": self.steps,
            "stood_at": self.stood,
            "handed_back_at": self.back,
            "walked_after": 0 if self.back is None else walked - self.after,
        }


class Supervisor:
    """Walks, and lets the stepper catch what the walk cannot absorb.

    Args:
        walker: The walk.
        stepper: What catches it.
        start: (n,) rad, the pose that the walk begins with.
        table: Which pushes are for the stepper.

    Attributes:
        holder: Who has the robot.
        catches: What the stepper was called for.
    """

    def __init__(self, walker: Balancer, stepper: Stepper, start: Array, table: CatchTable) -> None:
        self.walker, self.stepper, self.table = walker, stepper, table
        self._back = PoseHolder(walker.joints, start, RETURN)
        self._throw = CapturePointDeviation()
        self.holder: Holder = "walk"
        self.catches: list[Catch] = []

    def reset(self, observation: Observation) -> None:
        """Begin to walk.

        Raises:
            StateMissingError: The observation has no base state.
        """
        self.catches.clear()
        self.holder = "walk"
        self._calm = -np.inf
        self._throw.reset()
        self.walker.reset(observation)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of whoever has the robot.

        Raises:
            StateMissingError: The observation has no base state.
        """
        if self.holder == "walk":
            thrown = self._thrown(observation, dt)
            if not self._lost(thrown, observation.time):
                return self.walker.step(observation, dt)
            self._catch(observation, thrown)
        if self.holder == "step":
            command = self.stepper.step(observation, dt)
            if not self._stands(observation.time):
                return command
            self.holder, self._since = "return", observation.time
            self._back.reset(observation)
        if observation.time - self._since < RETURN:
            return self._back.step(observation, dt)
        self._walk_on(observation)
        return self.walker.step(observation, dt)

    def _thrown(self, observation: Observation, dt: float) -> Array:
        """Return how far (2,) m the capture point is off its usual way: ahead, to the left."""
        walker = self.walker
        if (moment := walker.moment) is None:
            return np.zeros(2)
        here = walker.body.measure(observation)
        away = capture_point(walker.body.momenta()) - here.feet[0, moment.stance, :2]
        heading = turn(walker.heading)[:2, :2].T
        tick = round(moment.elapsed / dt) - 1  # the tick that the state was entered in is over
        return self._throw.detect(moment.state, tick, heading @ away)

    def _lost(self, thrown: Array, now: float) -> bool:
        """Return whether a push has just thrown it too far."""
        if float(np.linalg.norm(thrown)) < CALM:
            self._calm = now
        return self.table.meets(thrown) and now - self._calm <= FRESH

    def _catch(self, observation: Observation, thrown: Array) -> None:
        """Let the stepper take over."""
        self.holder = "step"
        self.catches.append(Catch(observation.time, thrown, self.walker.steps))
        self._moved = observation.time
        self.stepper.take(observation)

    def _stands(self, now: float) -> bool:
        """Return whether the robot has stood still for long enough."""
        catch, stepper = self.catches[-1], self.stepper
        catch.steps = stepper.steps
        speed = float(np.linalg.norm(stepper.footing.momenta.velocity[:2]))
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
