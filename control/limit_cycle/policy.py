"""The gait as a batch policy, which the predictor plays in its rollouts of a step."""

import numpy as np

from windup.control.pose_graph.goal_limits import GoalLimits
from windup.control.pose_graph.pose_tracker import PoseTracker
from windup.hal.controller import PolicyInput
from windup.hal.joints import Array, Mask
from windup.hal.observation import Observation


class StepPolicy:
    """Plays the rest of one step on m rollouts, each with its own scalings.

    Args:
        tracker: m trackers at the start of the step.
        limits: Limits of the targets.
        sent: (n,) last target before the start, rad, or None.
    """

    def __init__(self, tracker: PoseTracker, limits: GoalLimits, sent: Array | None = None) -> None:
        self.tracker, self.limits, self._sent = tracker, limits, sent
        self.size = len(tracker.scale)
        self.done: Mask = np.zeros(self.size, dtype=bool)
        self._ticks = 0
        self._time = 0.0
        self._later: tuple[float, Array] | None = None

    def rescale_at(self, time: float, scale: Array) -> None:
        """Schedule the scalings (m, p) to be applied `time` s after the start."""
        self._later = (time, scale) if time > 0.0 else None

    def step(self, state: PolicyInput, dt: float) -> Array:
        """Return targets (m, n) rad; `done` is set for rollouts whose step has ended."""
        if self._ticks:
            self.done |= self.tracker.advance(state.contacts)
        if self._later is not None and self._time >= self._later[0] - 1e-9:
            self.tracker.rescale(self._later[1])
            self._later = None
        self._ticks += 1
        self._time += dt
        goals = self.tracker.step(state, dt)
        self._sent = self.limits.apply(goals, self._sent, dt)
        return self._sent


def policy_input(observation: Observation) -> PolicyInput:
    """Return the state of one robot as a batch of one; the observation must have a base."""
    base = observation.base
    assert base is not None, "checked at reset"
    return PolicyInput(
        observation.joints.position[None],
        observation.joints.velocity[None],
        base.orientation[None],
        base.angular_velocity[None],
        observation.contacts[None],
    )
