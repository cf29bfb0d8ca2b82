"""The gait as a batch policy: what the predictor plays to see how a step would end."""

import numpy as np

from control.pose_tracker import PoseTracker
from hal.controller import PolicyInput
from hal.joints import Array, Mask
from hal.observation import Observation


class StepPolicy:
    """Plays the rest of one step on m rollouts, each with its own scalings.

    Args:
        tracker: m trackers at the start of the step.
        lower: (n,) smallest target, rad; the guard would clamp there.
        upper: (n,) largest target, rad.
    """

    def __init__(self, tracker: PoseTracker, lower: Array, upper: Array) -> None:
        self.tracker, self.lower, self.upper = tracker, lower, upper
        self.size = len(tracker.scale)
        self.done: Mask = np.zeros(self.size, dtype=bool)
        self._ticks = 0
        self._time = 0.0
        self._later: tuple[float, Array] | None = None

    def rescale_at(self, time: float, scale: Array) -> None:
        """Let the scalings (m, p) take over `time` s after the start."""
        self._later = (time, scale) if time > 0.0 else None

    def step(self, state: PolicyInput, dt: float) -> Array:
        """Return targets (m, n) rad; rollouts whose step has ended are `done`."""
        if self._ticks:
            self.done |= self.tracker.advance(state.contacts)
        if self._later is not None and self._time >= self._later[0] - 1e-9:
            self.tracker.rescale(self._later[1])
            self._later = None
        self._ticks += 1
        self._time += dt
        goals = self.tracker.step(state, dt)
        return np.minimum(np.maximum(goals, self.lower), self.upper)


def policy_input(observation: Observation) -> PolicyInput:
    """Return the state of one robot as a batch of one; the base has to be there."""
    base = observation.base
    assert base is not None, "checked at reset"
    return PolicyInput(
        observation.joints.position[None],
        observation.joints.velocity[None],
        base.orientation[None],
        base.angular_velocity[None],
        observation.contacts[None],
    )
