"""Where the joints of a robot stand in MuJoCo's positions and velocities."""

import mujoco
import numpy as np
import numpy.typing as npt

Place = slice | npt.NDArray[np.intp]
"""Places in an array: a slice, which gives a view, where they follow each other."""


def places(addresses: npt.ArrayLike) -> Place:
    """Return the places `addresses` (k,) of an array."""
    at = np.asarray(addresses, dtype=np.intp)
    first = int(at[0]) if at.size else 0
    if (at == np.arange(first, first + at.size)).all():
        return slice(first, first + at.size)
    return at


class JointPlaces:
    """Where n joints stand; passive ones and a free base may stand before and between them.

    Args:
        model: The model.
        names: The joints.

    Attributes:
        qpos: (n,) addresses of their positions.
        dofs: (n,) addresses of their velocities.
        position: The places of their positions.
        velocity: The places of their velocities.
    """

    def __init__(self, model: mujoco.MjModel, names: tuple[str, ...]) -> None:
        joints = np.array([model.joint(name).id for name in names], dtype=np.intp)
        self.qpos = model.jnt_qposadr[joints].astype(np.intp)
        self.dofs = model.jnt_dofadr[joints].astype(np.intp)
        self.position, self.velocity = places(self.qpos), places(self.dofs)
