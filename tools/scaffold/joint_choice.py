"""A joint that an example may move without the robot losing its balance, and how far."""

from typing import NamedTuple

import mujoco
import numpy as np

from windup.hal.errors import UsageError
from windup.hal.joints import Array
from windup.robots import RobotDescription

FAR, NEAR = 15.0, 3.0
"""How far a joint moves that bears nothing, and one that bears the robot, degrees."""


class Swing(NamedTuple):
    """A joint, and how far it may go from the stance and back, degrees (to its freer side)."""

    joint: str
    degrees: float


def harmless_swing(robot: RobotDescription) -> Swing:
    """Return the joint that moves least of the robot's mass and is not between base and feet.

    Where all are, one that turns about the vertical moves a little.

    Raises:
        UsageError: No joint has room for a degree.
    """
    model = robot.spec().compile()
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
    """Return how far (n,) each joint can go to its freer side, degrees; negative is down."""
    up = np.degrees(robot.joints.upper - robot.stance)
    down = np.degrees(robot.joints.lower - robot.stance)
    return np.where(up >= -down, up, down)


def _up_to_the_world(model: mujoco.MjModel, body: int) -> list[int]:
    """Return a body and all that it hangs on."""
    chain = []
    while body:
        chain.append(body)
        body = int(model.body_parentid[body])
    return chain
