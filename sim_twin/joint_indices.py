"""Indices of a robot's joints in MuJoCo's qpos and qvel."""

import mujoco
import numpy as np
import numpy.typing as npt

Index = slice | npt.NDArray[np.intp]
"""Indices into an array: a slice (which gives a view) where they are consecutive."""


def as_index(addresses: npt.ArrayLike) -> Index:
    """Return `addresses` (k,) as indices into an array: a slice when they are consecutive."""
    at = np.asarray(addresses, dtype=np.intp)
    first = int(at[0]) if at.size else 0
    if (at == np.arange(first, first + at.size)).all():
        return slice(first, first + at.size)
    return at


class JointIndices:
    """Indices of n joints in qpos and qvel, among passive joints and a free base.

    Args:
        model: The model.
        names: Names of the joints.

    Attributes:
        qpos: (n,) addresses of the joints in qpos.
        dofs: (n,) addresses of the joints in qvel.
        position: Indices of the joint positions in qpos.
        velocity: Indices of the joint velocities in qvel.
    """

    def __init__(self, model: mujoco.MjModel, names: tuple[str, ...]) -> None:
        joints = np.array([model.joint(name).id for name in names], dtype=np.intp)
        self.qpos = model.jnt_qposadr[joints].astype(np.intp)
        self.dofs = model.jnt_dofadr[joints].astype(np.intp)
        self.position, self.velocity = as_index(self.qpos), as_index(self.dofs)
