"""Inverse kinematics of one limb: joint angles for a target pose of its end."""

from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from windup.control.kinematics.rotation import turn_between
from windup.hal.errors import UsageError
from windup.hal.joints import Array

STEPS = 3
DAMPING = 1e-3
"""Damping of the least squares, m/rad: keeps the steps small near a stretched knee."""
LARGEST = 0.3
"""Maximum change of an angle in one iteration, rad."""
CLOSE = 1e-4
"""Error at which the iteration ends, m or rad."""


@dataclass(frozen=True, slots=True)
class Pose:
    """Position and attitude of a body or a sole.

    Attributes:
        position: (3,) m.
        rotation: (3, 3) rotation matrix; its columns are the axes of the body.
    """

    position: Array
    rotation: Array

    def seen_from(self, other: "Pose") -> "Pose":
        """Return this pose relative to `other`."""
        turned = other.rotation.T
        return Pose(turned @ (self.position - other.position), turned @ self.rotation)


class LimbIk:
    """Inverse kinematics of the chain from the base to one end, by damped least squares.

    Args:
        model: The robot alone: a free joint, then n hinges in MJCF order.
        base: Name of the body with the free joint.
        end: Name of the site at the limb's end.

    Attributes:
        joints: (k,) indices of the limb's joints, from the base outwards.
    """

    def __init__(self, model: mujoco.MjModel, base: str, end: str) -> None:
        self._model, self._data = model, mujoco.MjData(model)
        self._data.qpos[:7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
        self._site = model.site(end).id
        # Views, looked up once: to look one up takes as long as to copy it.
        self._angles = self._data.qpos[7:]
        self._position = self._data.site_xpos[self._site]
        self._rotation = self._data.site_xmat[self._site].reshape(3, 3)
        self.joints = _chain(model, model.body(base).id, int(model.site_bodyid[self._site]))
        if not self.joints.size:
            raise UsageError(f"no joint lies between {base!r} and {end!r}")
        self._lower, self._upper = model.jnt_range[1 + self.joints].T
        self._jacobian = np.zeros((6, model.nv))
        self._linear, self._angular = self._jacobian[:3], self._jacobian[3:]
        self._columns = 6 + self.joints
        self._one = np.eye(len(self.joints))

    def forward(self, position: Array) -> Pose:
        """Return the pose of the end in the base frame at joint positions (n,) rad."""
        self._angles[:] = position
        mujoco.mj_kinematics(self._model, self._data)
        return Pose(self._position.copy(), self._rotation.copy())

    def solve(self, target: Pose, start: Array, steps: int = STEPS) -> Array:
        """Return joint angles (k,) rad, within the limits, whose end pose is nearest to `target`.

        Args:
            target: Desired pose of the end in the base frame.
            start: (n,) initial joint positions, rad; those of other limbs have no effect.
            steps: Maximum number of iterations.
        """
        model, data = self._model, self._data
        self._angles[:] = start
        angles = start[self.joints]
        change = np.empty(len(angles))
        for _ in range(steps):
            self._angles[self.joints] = angles
            mujoco.mj_kinematics(model, data)
            error = self._error(target)
            if np.abs(error).max() < CLOSE:
                break
            mujoco.mj_comPos(model, data)
            mujoco.mj_jacSite(model, data, self._linear, self._angular, self._site)
            matrix = self._jacobian[:, self._columns]
            # Damping grows with the error (Sugihara 2011): converges for targets out of reach.
            square = matrix.T @ matrix + (DAMPING**2 + 0.5 * (error @ error)) * self._one
            mujoco.mju_cholFactor(square, 0.0)
            mujoco.mju_cholSolve(change, square, matrix.T @ error)
            # NumPy's clip takes five times as long for so few elements.
            angles += np.minimum(np.maximum(change, -LARGEST), LARGEST)
            angles = np.minimum(np.maximum(angles, self._lower), self._upper)
        return angles

    def _error(self, target: Pose) -> Array:
        """Return the error (6,) of position, m, and attitude, rad."""
        error = np.empty(6)
        np.subtract(target.position, self._position, out=error[:3])
        error[3:] = turn_between(self._rotation, target.rotation)
        return error


def _chain(model: mujoco.MjModel, base: int, body: int) -> npt.NDArray[np.intp]:
    """Return the indices of the hinges between the base and a body of its tree."""
    joints: list[int] = []
    while body not in (0, base):
        first = int(model.body_jntadr[body])
        joints += [first + k - 1 for k in range(int(model.body_jntnum[body]))]
        body = int(model.body_parentid[body])
    return np.array(sorted(joints), dtype=np.intp)
