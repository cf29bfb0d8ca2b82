"""Couplings: passive joints that a linkage moves with other joints, as constraints of an MJCF.

MuJoCo's `<equality><joint>` means ``y - y0 = a0 + a1 (x - x0) + .. + a4 (x - x0)^4`` (MuJoCo
XMLreference), with y0 and x0 the joint positions in the MJCF's own zero pose.
"""

from collections.abc import Iterable, Iterator
from math import radians

import mujoco
import numpy as np

from windup.hal.joints import Array
from windup.robots import mjcf
from windup.robots.mistake import SLACK, Mistake
from windup.robots.records import CouplingEntry, RobotFile

JOINT = mujoco.mjtObj.mjOBJ_JOINT
KIND = mujoco.mjtEq.mjEQ_JOINT
SLIDE = int(mujoco.mjtJoint.mjJNT_SLIDE)


def add_couplings(spec: mujoco.MjSpec, couplings: Iterable[CouplingEntry]) -> None:
    """Add the couplings of robot.toml; unknown names are left to the checks."""
    for coupling in couplings:
        y, x = spec.joint(coupling.joint), spec.joint(coupling.follows)
        if y is None or x is None or coupling.joint == coupling.follows:
            continue
        y0, x0 = _zero(spec, y), _zero(spec, x)
        added = spec.add_equality(
            type=KIND, objtype=JOINT, name1=coupling.joint, name2=coupling.follows
        )
        added.data[:5] = [coupling.offset + coupling.ratio * x0 - y0, coupling.ratio, 0, 0, 0]


def satisfy_couplings(model: mujoco.MjModel, qpos: Array, driven: Iterable[str]) -> None:
    """Set the coupled joints in `qpos` (nq,) consistent with the `driven` ones, in place.

    A linkage that violates its constraint would jump into place in the first physics step.
    """
    known = {model.joint(name).id for name in driven}
    left = np.flatnonzero((model.eq_type == int(KIND)) & model.eq_active0.astype(bool)).tolist()
    while ready := [eq for eq in left if _from(model, eq) & known]:
        for eq in ready:
            left.remove(eq)
            _solve(model, qpos, eq, known)
            known |= {int(model.eq_obj1id[eq]), int(model.eq_obj2id[eq])}


def coupling_mistakes(robot: RobotFile, model: mujoco.MjModel) -> Iterator[Mistake]:
    """Yield key and message of each mistake in the couplings of joints that exist."""
    entries = {joint.name: joint for joint in robot.joint}
    for coupling in robot.coupling:
        if coupling.follows not in entries or coupling.joint not in mjcf.names(model, "joint"):
            continue  # `joint_checks` reports unknown names
        key, joint = f"coupling {coupling.joint!r}", model.joint(coupling.joint)
        both = (model.eq_type == int(KIND)) & (model.eq_obj1id == joint.id)
        if both.sum() > 1:
            yield key, "is coupled twice, perhaps by an <equality> of the MJCF: remove one of them"
        driver = entries[coupling.follows]
        ends = sorted(coupling.offset + coupling.ratio * q for q in (driver.lower, driver.upper))
        low, high = joint.range
        if model.jnt_limited[joint.id] and (ends[0] < low - SLACK or ends[1] > high + SLACK):
            unit = "m" if joint.type[0] == SLIDE else "rad"
            yield (
                key,
                f"{driver.name!r} moves it from {ends[0]:g} to {ends[1]:g} {unit}, and its range "
                f"in the MJCF is {low:g} to {high:g}: widen that, or change ratio or offset",
            )


def _zero(spec: mujoco.MjSpec, joint: mujoco.MjsJoint) -> float:
    """Return the position of a joint in the MJCF's zero pose, rad or m."""
    hinge = int(joint.type) == mjcf.HINGE
    return radians(joint.ref) if hinge and spec.compiler.degree else float(joint.ref)


def _from(model: mujoco.MjModel, eq: int) -> set[int]:
    """Return the joints of a constraint from which its other joint can be computed."""
    first, second = int(model.eq_obj1id[eq]), int(model.eq_obj2id[eq])
    if second < 0:
        return set()
    linear = model.eq_data[eq, 1] != 0.0 and not model.eq_data[eq, 2:5].any()
    return {first, second} if linear else {second}


def _solve(model: mujoco.MjModel, qpos: Array, eq: int, known: set[int]) -> None:
    """Set the joint of a constraint that is not `known` from the other one, in `qpos`."""
    joints = [int(model.eq_obj1id[eq]), int(model.eq_obj2id[eq])]
    (y, y0), (x, x0) = ((at, model.qpos0[at]) for at in model.jnt_qposadr[joints])
    factors = model.eq_data[eq, :5]
    if joints[0] not in known:
        qpos[y] = y0 + np.polynomial.polynomial.polyval(qpos[x] - x0, factors)
    elif joints[1] not in known:
        qpos[x] = x0 + (qpos[y] - y0 - factors[0]) / factors[1]
