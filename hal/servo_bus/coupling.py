"""Two joints that are driven by two servos together, as in a differential or a two-rod ankle."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from windup.hal.joints import Array, Joints, Mask

Matrix = tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class Coupling:
    """``servo angles = matrix (first, second)``; sign, ratio and zero of each mount come after it.

    The stiffness of each servo acts on both joints, so the two joints cannot be given independent
    stiffnesses; they get the closest achievable ones.

    Attributes:
        first: Name of the joint whose mount describes the first servo.
        second: Name of the joint whose mount describes the second servo.
        matrix: Rows are servos, columns joints.
    """

    first: str
    second: str
    matrix: Matrix


class Couplings:
    """All couplings of a robot of n joints; values of uncoupled joints are passed unchanged.

    Raises:
        UnknownNameError: A coupling names a joint that the robot does not have.
        ValueError: A matrix cannot be inverted.
    """

    def __init__(self, joints: Joints, couplings: Sequence[Coupling]) -> None:
        self._parts: list[tuple[npt.NDArray[np.intp], Array, Array, Array, Array]] = []
        for coupling in couplings:
            matrix = np.array(coupling.matrix)
            try:
                inverse = np.linalg.inv(matrix)
            except np.linalg.LinAlgError:
                names = f"{coupling.first!r} and {coupling.second!r}"
                raise ValueError(f"the coupling of {names} cannot be inverted") from None
            squares = (matrix**2).T
            rows = joints.indices([coupling.first, coupling.second])
            self._parts.append((rows, matrix, inverse, squares, np.linalg.pinv(squares)))

    def __bool__(self) -> bool:
        return bool(self._parts)

    def servos(self, angles: Array) -> Array:
        """Return servo angles (n,) for joint angles (n,), rad."""
        result = angles.copy()
        for rows, matrix, *_ in self._parts:
            result[rows] = matrix @ angles[rows]
        return result

    def joints(self, angles: Array) -> Array:
        """Return joint angles (n,) for servo angles (n,), rad; the same for velocities."""
        result = angles.copy()
        for rows, _, inverse, *_ in self._parts:
            result[rows] = inverse @ angles[rows]
        return result

    def torques(self, torques: Array) -> Array:
        """Return joint torques (n,) for servo torques (n,), N m."""
        result = torques.copy()
        for rows, matrix, *_ in self._parts:
            result[rows] = matrix.T @ torques[rows]
        return result

    def servo_gains(self, gains: Array) -> Array:
        """Return the servo gains (n,), none negative, that best approximate joint gains (n,)."""
        result = gains.copy()
        for rows, _, _, _, back in self._parts:
            result[rows] = np.maximum(back @ gains[rows], 0.0)
        return result

    def joint_gains(self, gains: Array) -> Array:
        """Return the joint gains (n,) that result from servo gains (n,)."""
        result = gains.copy()
        for rows, _, _, squares, _ in self._parts:
            result[rows] = squares @ gains[rows]
        return result

    def oldest(self, times: Array) -> Array:
        """Return the oldest sample time of each joint (n,) from those of the servos (n,), s."""
        result = times.copy()
        for rows, *_ in self._parts:
            result[rows] = times[rows].min()
        return result

    def any(self, servos: Mask) -> Mask:
        """Return (n,) bool: joints that are driven by at least one of the `servos` (n,) bool."""
        result = servos.copy()
        for rows, *_ in self._parts:
            result[rows] = servos[rows].any()
        return result

    def servo_range(self, lower: Array, upper: Array) -> tuple[Array, Array]:
        """Return the smallest and largest servo angles (n,) for joint limits (n,), rad."""
        low, high = lower.copy(), upper.copy()
        for rows, matrix, *_ in self._parts:
            ends = np.stack([matrix * lower[rows], matrix * upper[rows]])
            low[rows], high[rows] = ends.min(axis=0).sum(axis=1), ends.max(axis=0).sum(axis=1)
        return low, high
