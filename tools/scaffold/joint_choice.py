"""Choice of a joint that an example can move while the robot stands."""

from typing import NamedTuple

import mujoco
import numpy as np

from windup.hal.errors import UsageError
from windup.hal.joints import Array
from windup.robots import RobotDescription

FAR, NEAR = 15.0, 3.0
"""Maximum motion of a joint that carries no load, and of one between base and feet, degrees."""


class Swing(NamedTuple):
    """A joint, and its motion from the stance toward the farther limit, degrees."""

    joint: str
    degrees: float


def harmless_swing(robot: RobotDescription) -> Swing:
    """Return the joint with the least mass behind it that is not between base and feet.

    If all joints are, it is one about the vertical, with a small motion.

    Raises:
        UsageError: No joint can move by a degree.
    """
    model = robot.model
    feet = [model.body(foot.body).id for foot in robot.feet]
    bearing = {body for foot in feet for body in _up_to_the_world(model, foot)}
    bodies = [int(model.joint(name).bodyid[0]) for name in robot.joints.names]
    idle = np.array([body not in bearing for body in bodies])
    mass = model.body_subtreemass[bodies]
    room, most = _room(robot), np.where(idle, FAR, NEAR)
    rank = np.where(idle, mass, 1e6 - np.abs(robot.axes[:, 2]))
    swings = np.trunc(np.sign(room) * np.minimum(np.abs(room) - 0.1, most))
    rank = np.where(np.abs(swings) >= 1.0, rank, np.inf)
    best = int(rank.argmin())
    if not np.isfinite(rank[best]):
        raise UsageError(f"no joint of {robot.name} can move a degree away from its stance")
    return Swing(robot.joints.names[best], float(swings[best]))


def _room(robot: RobotDescription) -> Array:
    """Return the signed distance (n,) from the stance to the farther joint limit, degrees."""
    up = np.degrees(robot.joints.upper - robot.stance)
    down = np.degrees(robot.joints.lower - robot.stance)
    return np.where(up >= -down, up, down)


def _up_to_the_world(model: mujoco.MjModel, body: int) -> list[int]:
    """Return a body and its parents up to the world."""
    chain = []
    while body:
        chain.append(body)
        body = int(model.body_parentid[body])
    return chain
