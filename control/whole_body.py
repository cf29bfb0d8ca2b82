"""Whole-body control: joint accelerations and contact forces that serve several objectives.

The multiobjective optimisation of Macchietto et al. 2009 and Wu & Zordan 2010, section 5, as a
quadratic programme; inverse dynamics turns its answer into torques at every tick.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import daqp
import numpy as np

from control.dynamics import Dynamics
from control.momenta import GRAVITY
from hal.errors import WindupError
from hal.joints import Array

EDGES: Final = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
EQUAL: Final = 5
"""daqp's mark of a constraint that always holds with equality."""
SOFT: Final = 8
"""Its mark of one that may be broken at a cost: torque limits, at speeds that none can stop."""
REGULAR: Final = 1e-6
"""Weight of every variable, so that the answer is the only one."""
REACH: Final = 10.0
"""Moment of inertia that makes angular momentum commensurate with the rest, kg m2."""


@dataclass(frozen=True)
class Weights:
    """How much each objective counts, for errors of accelerations in m/s2 and rad/s2."""

    com: float = 10.0
    angular: float = 1.0
    vertical: float = 1.0
    posture: float = 0.02
    trunk: float = 2.0
    swing: float = 30.0
    stance: float = 1000.0


@dataclass(frozen=True)
class Objectives:
    """What the body should do now.

    Attributes:
        com: (3,) acceleration of the centre of mass (Eq. 10), m/s2.
        angular: (3,) rate of the angular momentum (Eq. 11 about the vertical), N m.
        posture: (n,) accelerations of the joints (Eq. 9), rad/s2.
        trunk: (3,) angular acceleration of the base in its own frame, rad/s2.
        stance: Ends that stand.
        stance_rate: For each of these the acceleration (6,) that keeps it still.
        swing: End that swings, if any, and its acceleration (6,) m/s2 and rad/s2.
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
    """Accelerations (v,) and, for each standing end, forces (p, 3) N at its corners."""

    acceleration: Array
    forces: dict[int, Array]


class WholeBody:
    """The quadratic programme of a robot.

    Args:
        dynamics: Its equation of motion.
        limit: (n,) largest torques, N m.
        friction: Coefficient of the friction pyramid.
        weights: Of the objectives.
    """

    def __init__(
        self, dynamics: Dynamics, limit: Array, friction: float, weights: Weights | None = None
    ) -> None:
        self.dynamics, self._limit = dynamics, limit
        self._weights = weights or Weights()
        # Edges of a pyramid inside the cone, each with a vertical part of 1.
        self._edges = np.column_stack((friction * EDGES, np.ones(len(EDGES))))

    def plan(self, wanted: Objectives) -> Plan:
        """Return what serves `wanted` best within friction and torque limits.

        Raises:
            WindupError: There is no answer, which a body that can fall freely never meets.
        """
        dynamics = self.dynamics
        count = len(dynamics.bias)
        points = [dynamics.ground(end) for end in wanted.stance]
        spread = self._spread(wanted.stance, points)
        generator = self._forces(points)
        rows, goals = self._rows(wanted, points, generator)
        hessian = rows.T @ rows
        hessian[np.diag_indices_from(hessian)] += REGULAR
        matrix = np.hstack((dynamics.mass, -spread))
        free = len(hessian) - count
        low = np.concatenate((np.full(count, -1e5), np.zeros(free), -dynamics.bias))
        high = np.concatenate((np.full(count, 1e5), np.full(free, 1e5), -dynamics.bias))
        low[-len(self._limit) :] -= self._limit
        high[-len(self._limit) :] += self._limit
        sense = np.zeros(len(low), dtype=np.int32)
        sense[len(hessian) : len(hessian) + 6] = EQUAL
        sense[len(hessian) + 6 :] = SOFT
        answer, _, flag, _ = daqp.solve(hessian, -rows.T @ goals, matrix, high, low, sense)
        if flag < 1:
            raise WindupError(f"whole-body control found no accelerations (daqp: {flag})")
        forces = (generator @ answer[count:]).reshape(-1, 3)
        parts = np.split(forces, np.cumsum([len(part) for part in points])[:-1])
        return Plan(answer[:count], dict(zip(wanted.stance, parts, strict=True)))

    def torque(self, plan: Plan) -> Array:
        """Return the torques (n,) N m that do a plan in the state of now (inverse dynamics)."""
        dynamics = self.dynamics
        force = dynamics.mass @ plan.acceleration + dynamics.bias
        for end, forces in plan.forces.items():
            arms = dynamics.ground(end) - dynamics.ends[end].position
            wrench = np.concatenate((forces.sum(axis=0), np.cross(arms, forces).sum(axis=0)))
            force -= dynamics.jacobian(end).T @ wrench
        return np.clip(force[6:], -self._limit, self._limit)

    def _forces(self, points: Sequence[Array]) -> Array:
        """Return the matrix that makes forces (3 p,) of the sizes of the pyramids' edges."""
        return np.asarray(
            np.kron(np.eye(sum(len(part) for part in points)), self._edges.T), dtype=np.float64
        )

    def _spread(self, stance: Sequence[int], points: Sequence[Array]) -> Array:
        """Return the matrix (v, edges) that makes generalised forces of these sizes."""
        columns = []
        for end, part in zip(stance, points, strict=True):
            jacobian = self.dynamics.jacobian(end)
            for point in part:
                arm = point - self.dynamics.ends[end].position
                wrenches = np.column_stack((self._edges, np.cross(arm, self._edges)))
                columns.append(jacobian.T @ wrenches.T)
        return np.hstack(columns)

    def _rows(
        self, wanted: Objectives, points: Sequence[Array], generator: Array
    ) -> tuple[Array, Array]:
        """Return weighted rows and goals of the least squares over (accelerations, edges)."""
        weights, dynamics = self._weights, self.dynamics
        count = len(dynamics.bias)
        eye = np.eye(count)
        parts: list[tuple[float, Array, Array]] = [
            (weights.posture, eye[6:], wanted.posture),
            (weights.trunk, eye[3:6], wanted.trunk),
        ]
        for end, rate in zip(wanted.stance, wanted.stance_rate, strict=True):
            parts.append((weights.stance, dynamics.jacobian(end), rate - dynamics.drift(end)))
        if wanted.swing is not None:
            end, rate = wanted.swing
            parts.append((weights.swing, dynamics.jacobian(end), rate - dynamics.drift(end)))
        scaled = [np.sqrt(weight) * rows for weight, rows, _ in parts]
        left = np.vstack(scaled)
        goals = [np.sqrt(weight) * goal for weight, _, goal in parts]
        momentum, rates = self._momentum(wanted, np.vstack(points))
        right = momentum @ generator
        rows = np.block(
            [
                [left, np.zeros((len(left), right.shape[1]))],
                [np.zeros((len(right), count)), right],
            ]
        )
        return rows, np.concatenate((*goals, rates))

    def _momentum(self, wanted: Objectives, points: Array) -> tuple[Array, Array]:
        """Return weighted rows (6, 3 p) over the forces, which change both momenta, and goals."""
        body, weights = self.dynamics.momenta, self._weights
        linear = np.tile(np.eye(3), len(points)) / body.mass
        angular = np.hstack([_cross(point - body.com) for point in points]) / REACH
        scale = np.sqrt([weights.com] * 3 + [weights.angular] * 2 + [weights.vertical])
        lifted = wanted.com + np.array([0.0, 0.0, GRAVITY])
        goals = np.concatenate((lifted, wanted.angular / REACH))
        return scale[:, None] * np.vstack((linear, angular)), scale * goals


def _cross(arm: Array) -> Array:
    """Return the matrix (3, 3) that takes a force to its moment about `arm` (3,) away."""
    x, y, z = arm
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
