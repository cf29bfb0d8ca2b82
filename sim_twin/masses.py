"""Masses that stay where they are when geoms go: an MJCF may leave them to its geoms."""

import mujoco
import numpy as np


def keep_masses(spec: mujoco.MjSpec) -> None:
    """State mass and inertia of every body of `spec` as MuJoCo computes them from its geoms.

    A rollout has no geoms but those of the feet, and a plant scales masses: both need numbers on
    the bodies. A `spec` that states them all is left as it is.
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
    """Write what `model` has for `body` into it; a body without mass has nothing to state."""
    if model.body_mass[body.id] <= 0.0:
        return
    body.mass = model.body_mass[body.id]
    body.ipos = model.body_ipos[body.id]
    body.iquat = model.body_iquat[body.id]
    body.inertia = model.body_inertia[body.id]
    body.fullinertia = np.full(6, np.nan)
    body.explicitinertial = True
