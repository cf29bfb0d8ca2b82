"""Whole-body control: joint accelerations and contact forces for several weighted objectives.

The multiobjective optimisation of Macchietto et al. 2009 and Wu & Zordan 2010, section 5, as a
quadratic programme; inverse dynamics converts its solution into torques at every tick.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Final

import daqp
import numpy as np

from windup.control.whole_body.dynamics import Dynamics
from windup.control.whole_body.whole_body_file import Weights
from windup.hal.errors import WindupError
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array

EDGES: Final = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
EQUAL: Final = 5
"""daqp's flag for an equality constraint."""
SOFT: Final = 8
"""daqp's flag for a soft constraint: torque limits may be infeasible at high speeds."""
REGULAR: Final = 1e-6
"""Regularisation weight of every variable, which makes the solution unique."""
FASTEST: Final = 1000.0
"""Maximum acceleration of a plan, m/s2 and rad/s2: larger ones only shake a light foot."""
REACH: Final = 10.0
"""Moment of inertia by which angular momentum rates are scaled to accelerations, kg m2."""


@dataclass(frozen=True)
class Objectives:
    """Desired accelerations of the body.

    Attributes:
        com: (3,) acceleration of the centre of mass (Eq. 10), m/s2.
        angular: (3,) rate of the angular momentum (Eq. 11 about the vertical), N m.
        posture: (n,) accelerations of the joints (Eq. 9), rad/s2.
        trunk: (3,) angular acceleration of the base in its own frame, rad/s2.
        stance: Indices of the ends that stand.
        stance_rate: For each of these the acceleration (6,) that keeps it still.
        swing: Index of the end that swings and its acceleration (6,) m/s2 and rad/s2, or None.
    """

    com: Array
    angular: Array
    posture: Array
    trunk: Array
    stance: Sequence[int]
    stance_rate: Sequence[Array]
    swing: tuple[int, Array] | None = None


@dataclass(frozen=True)
class Plan:
    """Solution: accelerations (v,) and, for each standing end, forces (p, 3) N at its corners."""

    acceleration: Array
    forces: dict[int, Array]


class WholeBody:
    """The quadratic programme of a robot.

    Args:
        dynamics: The robot's equation of motion.
        limit: (n,) maximum torques, N m.
        friction: Coefficient of the friction pyramid.
        weights: Weights of the objectives.
    """

    def __init__(
        self, dynamics: Dynamics, limit: Array, friction: float, weights: Weights | None = None
    ) -> None:
        self.dynamics, self._limit = dynamics, limit
        self._weights = weights or Weights()
        # Edges of a pyramid inside the cone, each with a vertical part of 1.
        self._edges = np.column_stack((friction * EDGES, np.ones(len(EDGES))))
        # An arm (3,) times this matrix is its cross product with each edge, concatenated.
        self._levers = np.cross(np.eye(3)[:, None], self._edges).reshape(3, -1)

    def plan(self, wanted: Objectives) -> Plan:
        """Return the best plan for `wanted` within friction and torque limits.

        Raises:
            WindupError: There is no solution; for a body that can fall freely there always is one.
        """
        dynamics = self.dynamics
        hessian, linear = self._cost(wanted)
        matrix = np.hstack((dynamics.mass, -self._spread(wanted.stance)))
        count, size = matrix.shape
        low, high = np.full(size + count, -FASTEST), np.full(size + count, FASTEST)
        low[count:size], high[count:size] = 0.0, 1e5
        low[size:] = high[size:] = -dynamics.bias
        low[-len(self._limit) :] -= self._limit
        high[-len(self._limit) :] += self._limit
        sense = np.full(size + count, SOFT, dtype=np.int32)
        sense[count:size], sense[size : size + 6] = 0, EQUAL
        answer, _, flag, _ = daqp.solve(hessian, linear, matrix, high, low, sense)
        if flag < 1:
            raise WindupError(f"whole-body control found no accelerations (daqp: {flag})")
        forces = answer[count:].reshape(-1, len(self._edges)) @ self._edges
        ends = np.cumsum([len(dynamics.corners[end]) for end in wanted.stance])
        parts = np.split(forces, ends[:-1])
        return Plan(answer[:count], dict(zip(wanted.stance, parts, strict=True)))

    def torque(self, plan: Plan) -> Array:
        """Return the torques (n,) N m of a plan in the present state (inverse dynamics)."""
        dynamics = self.dynamics
        force = dynamics.mass @ plan.acceleration + dynamics.bias
        for end, forces in plan.forces.items():
            arms = dynamics.ground(end) - dynamics.ends[end].position
            lever = arms.T @ forces
            moment = (lever - lever.T)[[1, 2, 0], [2, 0, 1]]
            wrench = np.concatenate((forces.sum(axis=0), moment))
            force -= wrench @ dynamics.jacobian(end)
        return np.minimum(np.maximum(force[6:], -self._limit), self._limit)

    def _spread(self, stance: Sequence[int]) -> Array:
        """Return the matrix (v, edges) from edge force magnitudes to generalised forces."""
        rows = []
        for end in stance:
            arms = self.dynamics.ground(end) - self.dynamics.ends[end].position
            rows.append(self._wrenches(arms) @ self.dynamics.jacobian(end))
        return np.vstack(rows).T

    def _wrenches(self, arms: Array) -> Array:
        """Return force and moment (edges, 6) of each edge's unit force at `arms` (p, 3)."""
        count = len(self._edges)
        wrenches = np.empty((len(arms), count, 6))
        wrenches[:, :, :3] = self._edges
        wrenches[:, :, 3:] = (arms @ self._levers).reshape(len(arms), count, 3)
        return wrenches.reshape(-1, 6)

    def _cost(self, wanted: Objectives) -> tuple[Array, Array]:
        """Return Hessian and linear part of the least squares over (accelerations, edges)."""
        rows, goals = self._motion(wanted)
        momentum, rates = self._momentum(wanted)
        count = len(self.dynamics.bias)
        size = count + momentum.shape[1]
        hessian = REGULAR * np.eye(size)
        hessian[:count, :count] += rows.T @ rows
        hessian[count:, count:] += momentum.T @ momentum
        return hessian, -np.concatenate((goals @ rows, rates @ momentum))

    def _motion(self, wanted: Objectives) -> tuple[Array, Array]:
        """Return the weighted rows over the accelerations, and their goals."""
        weights, dynamics = self._weights, self.dynamics
        eye = np.eye(len(dynamics.bias))
        parts = [
            (weights.posture, eye[6:], wanted.posture),
            (weights.trunk, eye[3:6], wanted.trunk),
        ]
        ends = [
            (weights.stance, *part) for part in zip(wanted.stance, wanted.stance_rate, strict=True)
        ]
        if wanted.swing is not None:
            ends.append((weights.swing, *wanted.swing))
        for weight, end, rate in ends:
            parts.append((weight, dynamics.jacobian(end), rate - dynamics.drift(end)))
        rows = np.vstack([sqrt(weight) * part for weight, part, _ in parts])
        return rows, np.concatenate([sqrt(weight) * goal for weight, _, goal in parts])

    def _momentum(self, wanted: Objectives) -> tuple[Array, Array]:
        """Return the weighted rows (6, edges) of the momentum rates, and their goals."""
        body, weights = self.dynamics.momenta, self._weights
        points = np.vstack([self.dynamics.ground(end) for end in wanted.stance])
        rows = self._wrenches(points - body.com).T / np.repeat((body.mass, REACH), 3)[:, None]
        scale = np.sqrt([weights.com] * 3 + [weights.angular] * 2 + [weights.vertical])
        lifted = wanted.com + np.array([0.0, 0.0, GRAVITY])
        goals = np.concatenate((lifted, wanted.angular / REACH))
        return scale[:, None] * rows, scale * goals
