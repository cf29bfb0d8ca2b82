"""Two joints that two servos move together, as in a differential or an ankle of two rods."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from windup.hal.joints import Array, Joints, Mask

Matrix = tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class Coupling:
    """``servo angles = matrix (first, second)``; sign, ratio and zero of each mount come after it.

    The servos' stiffness acts on both joints; what the coupling cannot do is a stiffness of its
    own for each, so both get the closest there is.

    Attributes:
        first: Name of the joint whose mount holds the first servo.
        second: Name of the other.
        matrix: Rows are servos, columns joints.
    """

    first: str
    second: str
    matrix: Matrix


class Couplings:
    """All couplings of a robot of n joints; joints without one pass through.

    Raises:
        UnknownNameError: A joint that is not there.
        ValueError: A matrix that cannot be inverted.
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
        """Return servo gains (n,), none negative, that come closest to joint gains (n,)."""
        result = gains.copy()
        for rows, _, _, _, back in self._parts:
            result[rows] = np.maximum(back @ gains[rows], 0.0)
        return result

    def joint_gains(self, gains: Array) -> Array:
        """Return the joint gains (n,) that servo gains (n,) make."""
        result = gains.copy()
        for rows, _, _, squares, _ in self._parts:
            result[rows] = squares @ gains[rows]
        return result

    def oldest(self, times: Array) -> Array:
        """Return when each joint (n,) was last known, from when each servo (n,) answered, s."""
        result = times.copy()
        for rows, *_ in self._parts:
            result[rows] = times[rows].min()
        return result

    def any(self, servos: Mask) -> Mask:
        """Return which joints (n,) one of the `servos` (n,) moves."""
        result = servos.copy()
        for rows, *_ in self._parts:
            result[rows] = servos[rows].any()
        return result

    def extent(self, lower: Array, upper: Array) -> tuple[Array, Array]:
        """Return the smallest and largest servo angles (n,) of joints between (n,) limits, rad."""
        low, high = lower.copy(), upper.copy()
        for rows, matrix, *_ in self._parts:
            ends = np.stack([matrix * lower[rows], matrix * upper[rows]])
            low[rows], high[rows] = ends.min(axis=0).sum(axis=1), ends.max(axis=0).sum(axis=1)
        return low, high
