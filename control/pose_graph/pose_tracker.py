"""Tracking of a pose graph: from its state to joint targets, for one robot or many rollouts.

All arrays have a leading batch axis of m copies, so that the control loop (m = 1) and the
rollouts run the same code.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.torso_servo import TorsoServo
from windup.hal.contacts import ContactSensors
from windup.hal.controller import PolicyInput
from windup.hal.joints import Array, Mask

EPSILON = 1e-9
Indices = npt.NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class TrackerState:
    """Positions of m trackers in their graphs.

    Attributes:
        state: (m,) index of the present state.
        elapsed: (m,) time in that state at the next tick, s.
        steps: (m,) number of finished steps.
    """

    state: Indices
    elapsed: Array
    steps: Indices

    @classmethod
    def begin(cls, size: int = 1) -> "TrackerState":
        """Return `size` trackers at the first state."""
        zeros = np.zeros(size, dtype=np.intp)
        return cls(zeros, np.zeros(size), zeros.copy())

    def repeat(self, size: int) -> "TrackerState":
        """Return `size` copies of a single tracker."""
        return TrackerState(
            self.state.repeat(size), self.elapsed.repeat(size), self.steps.repeat(size)
        )


class PoseTracker:
    """Follows the pose graph of a gait on m robots, each with its own scalings.

    Args:
        gait: Graph and perturbations.
        contacts: The robot's contact sensors.
        scale: (m, p) scalings K of the gait's p perturbations.
        at: Initial positions in the graph; the first state by default.
        torso_servo: The torso servo, or None.
    """

    def __init__(
        self,
        gait: Gait,
        contacts: ContactSensors,
        scale: Array,
        at: TrackerState | None = None,
        torso_servo: TorsoServo | None = None,
    ) -> None:
        self.gait, self.contacts, self.torso_servo = gait, contacts, torso_servo
        self._rows = np.arange(len(scale))
        at = at or TrackerState.begin(len(scale))
        self._state, self._elapsed, self._steps = at.state, at.elapsed.copy(), at.steps
        self.rescale(scale)

    @property
    def now(self) -> TrackerState:
        """Present positions of the trackers in their graphs."""
        return TrackerState(self._state, self._elapsed.copy(), self._steps)

    @property
    def state(self) -> Indices:
        """(m,) indices of the present states."""
        return self._state

    @property
    def elapsed(self) -> Array:
        """(m,) times in the present states, s; changed in place by the next tick."""
        return self._elapsed

    def restart(self) -> None:
        """Go back to the first state."""
        at = TrackerState.begin(len(self.scale))
        self._state, self._elapsed, self._steps = at.state, at.elapsed, at.steps
        self._look_up()

    def rescale(self, scale: Array) -> None:
        """Apply new scalings (m, p): C = B + K dP."""
        graph = self.gait.graph
        self.scale = scale
        self.pose = graph.pose + np.tensordot(scale, self.gait.pose_change, axes=1)
        self.hold = np.maximum(graph.hold + scale @ self.gait.hold_change, 0.0)
        self._look_up()

    def step(self, state: PolicyInput, dt: float) -> Array:
        """Return targets (m, n) rad for the tick that begins now, and advance time by `dt` s."""
        self._elapsed += dt
        if self.torso_servo is not None:
            return self.torso_servo.apply(self._pose, state)
        return self._pose

    def advance(self, contacts: Array) -> Mask:
        """Make the transitions that are due, for contact forces (m, k) N.

        Returns:
            (m,) bool: trackers that have just ended a step.
        """
        graph = self.gait.graph
        due = self._expired()
        if self._listening:
            due |= (self.contacts.pressed(contacts) & self._sensors).any(axis=1)
        if not due.any():
            return due
        at = self._state
        due &= graph.successor[at] != at
        ended = due & graph.ends_step[at]
        self._state = np.where(due, graph.successor[at], at)
        self._elapsed[due] = 0.0
        self._steps = self._steps + ended
        self._look_up()
        return ended

    def finished(self) -> Mask:
        """Return (m,) bool: trackers whose hold time in a last state has passed."""
        return self._expired() & (self.gait.graph.successor[self._state] == self._state)

    def stance(self) -> Indices:
        """Return (m,) index of the stance foot of the present step, -1 if there is none."""
        return self.gait.graph.stance[self._state]

    def _expired(self) -> Mask:
        """Return (m,) bool: trackers whose hold time or time-out has passed."""
        return self._elapsed >= self._deadline

    def _look_up(self) -> None:
        """Cache pose, deadline and sensors of the present states, to save time per tick."""
        graph, at = self.gait.graph, self._state
        self._pose = self.pose[self._rows, at]
        self._deadline = np.minimum(self.hold[self._rows, at], graph.timeout[at]) - EPSILON
        self._sensors: Mask = graph.sensors[at]
        self._listening = bool(self._sensors.any())
