"""Planning of a step: from its start state to scalings that reach its targets.

The planner contains everything that a step model needs, so that it can run within a tick of the
loop (unpaced), or in another process (paced, where its answer is applied `latency` s into the
step).
"""

from dataclasses import dataclass
from math import ceil
from typing import Protocol

import numpy as np

from windup.control.kinematics.robot_state import RobotState
from windup.control.limit_cycle.policy import StepPolicy
from windup.control.limit_cycle.step_model import StepModel
from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.goal_limits import GoalLimits
from windup.control.pose_graph.pose_tracker import PoseTracker, TrackerState
from windup.control.pose_graph.torso_servo import TorsoServo
from windup.control.regulation.step_record import StepStart
from windup.control.regulation.variables import RegulationVariable
from windup.hal.contacts import ContactSensors
from windup.hal.controller import Predictor, RolloutStart
from windup.hal.joints import Array, Joints, Mask


@dataclass(frozen=True)
class StepRequest:
    """A request to plan a step, or the rest of one.

    Attributes:
        start: Robot state, commands in flight and tick.
        at: State of the pose tracker, a batch of one.
        stance: Index of the stance foot.
        phase: Index of the state that the step began with; each has its own step model.
        scale: (p,) scalings of all perturbations, before balance is added.
        before: (p,) scalings in effect until the answer is applied.
        target: (r,) targets of the regulation variables.
        origin: Start of the step, if it began before `start`.
    """

    start: RolloutStart
    at: TrackerState
    stance: int
    phase: int
    scale: Array
    before: Array
    target: Array
    origin: StepStart | None = None

    def ticks(self, latency: float) -> int:
        """Return the tick, counted from 0, at which an answer is applied after `latency` s."""
        return ceil(latency / self.start.dt - 1e-6)

    def due(self, latency: float) -> float:
        """Return the time of that tick, minus half a tick against wall-clock jitter, s."""
        return self.start.observation.time + (self.ticks(latency) - 0.5) * self.start.dt


class Planner(Protocol):
    """Computes the answers to requests, immediately or later."""

    @property
    def latency(self) -> float:
        """Time from the start of a step until its scalings are applied, s."""
        ...

    def reset(self) -> None:
        """Start over for a new walk; a pending request is discarded."""
        ...

    def ask(self, request: StepRequest) -> None:
        """Request the scalings of a step; an earlier request is discarded."""
        ...

    def answer(self, time: float) -> Array | None:
        """Return the requested scalings (r,) once they are due at `time`, s; None until then.

        Raises:
            PlannerError: The planner has failed.
        """
        ...


@dataclass
class StepPlanner:
    """Plans steps with rollouts, synchronously in `ask`.

    Attributes:
        gait: The gait.
        joints: The robot's joints.
        contacts: Its contact sensors.
        state: Its state.
        regulation: The r regulation variables.
        perturbations: Names of the r perturbations that control them.
        model: The step model.
        predictor: Runs the rollouts.
        torso_servo: The torso servo, or None.
        horizon: Maximum duration of a step in a rollout, s.
        latency: Time from the start of a step until its scalings are applied, s.
    """

    gait: Gait
    joints: Joints
    contacts: ContactSensors
    state: RobotState
    regulation: list[RegulationVariable]
    perturbations: list[str]
    model: StepModel
    predictor: Predictor
    torso_servo: TorsoServo | None = None
    horizon: float = 1.5
    latency: float = 0.0

    def __post_init__(self) -> None:
        self._columns = [self.gait.index(name) for name in self.perturbations]
        self._limits = GoalLimits(self.joints)
        self._answer: Array | None = None
        self._due = 0.0

    def reset(self) -> None:
        """Reset the step model, and discard the last answer."""
        self.model.reset()
        self._answer = None

    def ask(self, request: StepRequest) -> None:
        """Plan the step immediately."""
        self._answer = self.plan(request)
        self._due = request.due(self.latency)

    def answer(self, time: float) -> Array | None:
        """Return the result of `ask` once it is due; later calls return None."""
        if time < self._due:
            return None
        answer, self._answer = self._answer, None
        return answer

    def plan(self, request: StepRequest) -> Array:
        """Return the scalings (r,) for the step."""
        now = StepStart.of(request.start.observation, request.stance, self.state)
        start = request.origin or now

        def sample(scalings: Array) -> tuple[Array, Mask]:
            scale = np.repeat(request.scale[None], len(scalings), axis=0)
            scale[:, self._columns] += scalings
            policy = self.policy(request, scale)
            outcomes = self.predictor.predict(request.start, policy, self.horizon)
            values = start.evaluate(outcomes, self.regulation, self.contacts)
            return values, outcomes.fell | ~policy.done

        here = now.features()
        at = int(request.at.state[0])
        return self.model.control(sample, request.target, request.phase, here, at)

    def policy(self, request: StepRequest, scale: Array) -> StepPolicy:
        """Return the batch policy that plays the requested step with scalings (m, p)."""
        size = len(scale)
        ticks = request.ticks(self.latency)
        first = np.repeat(request.before[None], size, axis=0) if ticks else scale
        at = request.at.repeat(size)
        tracker = PoseTracker(self.gait, self.contacts, first, at, self.torso_servo)
        sent = request.start.in_flight
        policy = StepPolicy(tracker, self._limits, sent[-1] if len(sent) else None)
        policy.rescale_at(ticks * request.start.dt, scale)
        return policy
