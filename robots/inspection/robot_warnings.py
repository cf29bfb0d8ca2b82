"""Warnings about valid but probably unintended contents of a robot's files."""

from collections.abc import Iterator

import mujoco
import numpy as np

from windup.hal.geometry.gravity import GRAVITY
from windup.robots.description import RobotDescription
from windup.robots.inspection.posture_warnings import posture_warnings
from windup.robots.inspection.servo_warnings import servo_warnings
from windup.robots.inspection.stance import in_stance

POINTS = (int(mujoco.mjtGeom.mjGEOM_SPHERE), int(mujoco.mjtGeom.mjGEOM_ELLIPSOID))
DEEP = 1e-3
"""Maximum penetration of bodies that only touch, m."""
DOWN = (0.0, 0.0, -GRAVITY)


def robot_warnings(robot: RobotDescription) -> list[str]:
    """Return warnings about a robot's MJCF and robot.toml, one line each, with a remedy."""
    model, data = in_stance(robot)
    return [
        *_floor(robot, model),
        *_gravity(model),
        *_points(robot, model, data),
        *_armature(robot, model),
        *_neighbours(model, data),
        *servo_warnings(robot),
        *posture_warnings(robot, model, data),
    ]


def _gravity(model: mujoco.MjModel) -> Iterator[str]:
    """Yield a warning if the gravity of the MJCF is not that of the earth."""
    if np.abs(model.opt.gravity - DOWN).max() > 0.05:
        given = " ".join(f"{value:g}" for value in model.opt.gravity)
        yield f"gravity is {given} m/s2 in the MJCF's <option>; omit it for 0 0 -9.81"


def _floor(robot: RobotDescription, model: mujoco.MjModel) -> Iterator[str]:
    """Yield a warning if there is no floor."""
    solid = (model.geom_contype > 0) | (model.geom_conaffinity > 0)
    if not robot.fixed and not (solid & (model.body_weldid[model.geom_bodyid] == 0)).any():
        plane = '<geom type="plane" size="0 0 0.05"/>'
        yield f"no floor: the robot falls without end; add {plane} to the <worldbody>"


def _points(robot: RobotDescription, model: mujoco.MjModel, data: mujoco.MjData) -> Iterator[str]:
    """Yield a warning for each foot without colliding geoms, or on fewer than 3 round ones."""
    solid = (model.geom_contype > 0) | (model.geom_conaffinity > 0)
    for foot in robot.feet:
        geoms = np.flatnonzero(solid & (model.geom_bodyid == model.body(foot.body).id))
        if not geoms.size:
            yield f"foot {foot.name!r} touches nothing: no geom of body {foot.body!r} collides"
            continue
        kinds = model.geom_type[geoms]
        lowest = int(kinds[data.geom_xpos[geoms, 2].argmin()])
        if lowest in POINTS and np.isin(kinds, POINTS).sum() < 3:
            bears = "a box for its sole does"
            yield f"foot {foot.name!r} stands on points, which cannot support a moment; {bears}"


def _armature(robot: RobotDescription, model: mujoco.MjModel) -> Iterator[str]:
    """Yield a warning if joints with servos have no armature."""
    bare = [
        (name, servo)
        for name, servo in zip(robot.joints.names, robot.servos, strict=True)
        if servo is not None and model.dof_armature[model.joint(name).dofadr[0]] == 0.0
    ]
    if bare:
        names, servo = ", ".join(name for name, _ in bare), bare[0][1]
        rotor = servo.model.armature * servo.ratio**2
        yield (
            f"armature 0 at {names}: a servo's rotor turns with its joint; an {servo.model.name} "
            f"has armature={rotor:.2g}"
        )


def _neighbours(model: mujoco.MjModel, data: mujoco.MjData) -> Iterator[str]:
    """Yield a warning for each pair of bodies that penetrate each other in the stance."""
    mujoco.mj_collision(model, data)
    pairs = set()
    for contact in data.contact:
        one, other = sorted(model.geom_bodyid[contact.geom].tolist())
        if model.body_weldid[one] and model.body_weldid[other] and contact.dist < -DEEP:
            pairs.add((model.body(one).name, model.body(other).name))
    for first, second in sorted(pairs):
        yield (
            f"bodies {first!r} and {second!r} collide in the stance: they push each other apart; "
            "let robots' geoms have contype 0, or <exclude> the pair"
        )
