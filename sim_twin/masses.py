"""Writes masses and inertias explicitly into the bodies of an MJCF that infers them from geoms."""

import mujoco
import numpy as np


def set_explicit_masses(spec: mujoco.MjSpec) -> None:
    """Write mass and inertia into every body of `spec`, as MuJoCo computes them from its geoms.

    Needed because a rollout deletes all geoms but those of the feet, and because a plant scales
    masses. A `spec` in which all bodies state them is not changed.
    """
    compiler = spec.compiler
    geoms_win = compiler.inertiafromgeom == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
    open_ = [body for body in spec.bodies[1:] if geoms_win or not body.explicitinertial]
    if compiler.settotalmass > 0.0:
        open_ = list(spec.bodies[1:])
    if not open_:
        return
    model = spec.compile()
    for body in open_:
        _state(body, model)
    compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    compiler.settotalmass = -1.0


def _state(body: mujoco.MjsBody, model: mujoco.MjModel) -> None:
    """Copy mass and inertia of `body` from `model`; skip a body without mass."""
    if model.body_mass[body.id] <= 0.0:
        return
    body.mass = model.body_mass[body.id]
    body.ipos = model.body_ipos[body.id]
    body.iquat = model.body_iquat[body.id]
    body.inertia = model.body_inertia[body.id]
    body.fullinertia = np.full(6, np.nan)
    body.explicitinertial = True
