"""Check for invalid numbers of an MJCF that MuJoCo accepts: not finite, huge, or negative."""

from collections.abc import Iterator
from typing import Any, Final

import mujoco
import numpy as np

from windup.hal.config import LARGEST

KINDS: Final = {"body": "body", "jnt": "joint", "dof": "joint", "geom": "geom", "site": "site"}
"""Kinds of objects in messages, by the prefix of a model's fields."""
NOT_NEGATIVE: Final = ("dof_armature", "dof_damping", "dof_frictionloss", "jnt_stiffness")
FIELDS: Final = (
    *("body_pos", "body_quat", "body_mass", "body_inertia", "body_ipos"),
    *("jnt_pos", "jnt_axis", "jnt_range", *NOT_NEGATIVE),
    *("geom_size", "geom_pos", "geom_quat", "geom_friction", "geom_margin", "geom_gap"),
    *("geom_solref", "geom_solimp", "site_pos", "site_quat", "site_size"),
)
"""Checked fields of a model, which an MJCF sets."""
TIMESTEP: Final = (1e-5, 0.05)
"""Minimum and maximum physics step, s."""


def wrong_numbers(model: mujoco.MjModel) -> Iterator[str]:
    """Yield a message about each field of `model` with an invalid number."""
    step, gravity = float(model.opt.timestep), model.opt.gravity
    if not TIMESTEP[0] <= step <= TIMESTEP[1]:
        yield f"option timestep: {step:g} s is outside {TIMESTEP[0]:g} .. {TIMESTEP[1]:g} s"
    if not (np.abs(gravity) <= LARGEST).all():
        yield f"option gravity: {gravity} is not finite"
    for name in FIELDS:
        values = getattr(model, name)
        if not (fine := np.abs(values) <= LARGEST).all():
            yield _said(model, name, values, fine, "is not finite, or huge")
        elif name in (*NOT_NEGATIVE, "geom_friction") and not (fine := values >= 0.0).all():
            yield _said(model, name, values, fine, "is negative")


def _said(model: mujoco.MjModel, field: str, values: Any, fine: Any, what: str) -> str:
    """Return a message with object, field and value of the first value that is not `fine`."""
    at = tuple(np.argwhere(~fine)[0])
    kind, _, name = field.partition("_")
    index = int(model.dof_jntid[at[0]]) if kind == "dof" else int(at[0])
    label = getattr(model, KINDS[kind])(index).name or f"number {index}"
    return f"{KINDS[kind]} {label!r}, {name}: {values[at]:g} {what}"
