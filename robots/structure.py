"""Checks of base and joints of an MJCF against its robot.toml."""

from collections.abc import Iterator

import mujoco
import numpy as np

from windup.robots import mjcf
from windup.robots.mistake import Mistake, check_known
from windup.robots.records import RobotFile

SLIDE = int(mujoco.mjtJoint.mjJNT_SLIDE)


def is_fixed(model: mujoco.MjModel) -> bool:
    """Return whether the MJCF has no free joint: the base is fixed to the world, as of an arm."""
    return mjcf.FREE not in model.jnt_type


def structure_mistakes(robot: RobotFile, model: mujoco.MjModel) -> Iterator[Mistake]:
    """Yield key and message of each mismatch between robot.toml and MJCF in base and joints."""
    bodies = mjcf.names(model, "body")
    yield from check_known("base", "body", robot.base, bodies)
    yield from check_known("torso", "body", robot.torso, bodies)
    if robot.base in bodies:
        yield from _of_the_base(robot, model)
    if model.nu:
        yield "model", _actuators(model)
    yield from _of_the_joints(robot, model)


def _of_the_base(robot: RobotFile, model: mujoco.MjModel) -> Iterator[Mistake]:
    base, free = model.body(robot.base), np.flatnonzero(model.jnt_type == mjcf.FREE)
    if len(free) > 1:
        yield "model", f"the MJCF has {len(free)} free joints; only the base may have one"
    if len(free) and (base.jntnum[0] != 1 or base.jntadr[0] != free[0]):
        floats = model.body(int(model.jnt_bodyid[free[0]])).name
        yield "base", f"body {robot.base!r} has no free joint in the MJCF; body {floats!r} has it"
    if len(free) and free[0] != 0:
        yield "base", "its free joint has to be the first joint of the MJCF"
    if not len(free) and model.body_weldid[base.id] != 0:
        yield "base", f"body {robot.base!r} moves with a joint; name one that is fixed to the world"
    if len(free) and robot.fall is None:
        yield (
            "fall",
            "is missing: give [fall] with height and tilt, beyond which it counts as fallen",
        )
    if not len(free) and robot.foot:
        yield "foot", "feet are for a robot whose base has a free joint; this one is fixed"


def _actuators(model: mujoco.MjModel) -> str:
    """Return the message for an MJCF with actuators, with their names."""
    listed = [model.actuator(i).name or f"number {i + 1}" for i in range(model.nu)]
    shown = ", ".join(listed[:4]) + (", ..." if len(listed) > 4 else "")
    return (
        f"the MJCF has actuators ({shown}): delete its <actuator> section; the [drive] of "
        "robot.toml says what moves a joint"
    )


def _of_the_joints(robot: RobotFile, model: mujoco.MjModel) -> Iterator[Mistake]:
    entries = [joint.name for joint in robot.joint]
    if not entries:
        yield (
            "joint",
            "is missing: a robot needs at least one [[joint]], with name and, on a bus, id",
        )
    for index, kind in enumerate(model.jnt_type):
        name = model.joint(index).name
        passive = name in robot.joints_without_servo
        if kind == mjcf.HINGE and passive and name in entries:
            key = "passive" if name in robot.passive else "coupling"
            yield key, f"{name!r} is a [[joint]] as well; remove one of them"
        if kind == mjcf.HINGE and not passive and name not in entries:
            how = "or name it in passive or a [[coupling]], where no servo moves it"
            yield "joint", f"the MJCF hinge {name!r} has no [[joint]]; give it one, {how}"
        if kind not in (mjcf.HINGE, mjcf.FREE) and not (kind == SLIDE and passive):
            yield "model", f"joint {name!r} is {_undriven(kind)}"


def _undriven(kind: int) -> str:
    """Return the message for a joint that no servo can move: its kind, and the remedy."""
    if kind == SLIDE:
        return "a slide, and servos turn hinges: name it in passive, if no servo moves it"
    return "a ball joint: make it three hinges"
