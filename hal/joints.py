"""The joints of a robot: names in MJCF order, limits and default gains as arrays."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from windup.hal.errors import UnknownNameError

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]
Flags = npt.NDArray[np.uint32]
"""Bits by joint: what the bits mean is told where such an array stands."""
ARRAYS = ("lower", "upper", "stiffness", "damping", "torque", "velocity", "goal_speed")


@dataclass(frozen=True, slots=True)
class Joint:
    """One actuated hinge joint.

    Attributes:
        name: Name in the MJCF.
        lower: Smallest allowed target, rad.
        upper: Largest allowed target, rad.
        stiffness: Default proportional gain, N m/rad.
        damping: Default derivative gain, N m s/rad.
        torque: Maximum torque, N m.
        velocity: Maximum velocity, rad/s.
        goal_speed: Maximum speed at which the servo moves its internal goal, rad/s.
    """

    name: str
    lower: float
    upper: float
    stiffness: float
    damping: float
    torque: float = np.inf
    velocity: float = np.inf
    goal_speed: float = np.inf


@dataclass(frozen=True)
class Joints:
    """All joints of a robot in MJCF order; `n` is their number.

    The arrays have shape (n,) and are read-only. Names are resolved to indices once, with
    `index`; all later code works on arrays.
    """

    joints: tuple[Joint, ...]
    names: tuple[str, ...] = field(init=False)
    lower: Array = field(init=False, repr=False)
    upper: Array = field(init=False, repr=False)
    stiffness: Array = field(init=False, repr=False)
    damping: Array = field(init=False, repr=False)
    torque: Array = field(init=False, repr=False)
    velocity: Array = field(init=False, repr=False)
    goal_speed: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", tuple(joint.name for joint in self.joints))
        for key in ARRAYS:
            values = np.array([getattr(joint, key) for joint in self.joints], dtype=np.float64)
            values.setflags(write=False)
            object.__setattr__(self, key, values)

    def __len__(self) -> int:
        return len(self.joints)

    def index(self, name: str) -> int:
        """Return the index of the joint `name`.

        Raises:
            UnknownNameError: There is no such joint; the message suggests the likely one.
        """
        try:
            return self.names.index(name)
        except ValueError:
            raise UnknownNameError("joint", name, self.names) from None

    def indices(self, names: Iterable[str]) -> npt.NDArray[np.intp]:
        """Return the indices of several joints, in the order given."""
        return np.array([self.index(name) for name in names], dtype=np.intp)

    def array(self, values: Mapping[str, float], default: float = 0.0) -> Array:
        """Return an (n,) array with `values` by name and `default` elsewhere."""
        result = np.full(len(self), default)
        for name, value in values.items():
            result[self.index(name)] = value
        return result
