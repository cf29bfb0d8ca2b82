"""Geometry of a robot for its picture: links, joint axes, soles and centre of mass."""

from dataclasses import dataclass
from itertools import combinations

import mujoco
import numpy as np
from scipy.spatial import ConvexHull, QhullError

from windup.hal.joints import Array
from windup.robots import RobotDescription, mjcf
from windup.robots.inspection.posture_warnings import corners_of, sole_points
from windup.robots.inspection.stance import in_stance

FLAT = 0.02
"""Maximum height of a sole's corners above the lowest one, m."""
EDGES = [(a, b) for a, b in combinations(range(8), 2) if (a ^ b) in (1, 2, 4)]
"""Edges of a box, as pairs of corners; their numbers differ in one bit."""
FLOORS = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD))


@dataclass(frozen=True)
class Outline:
    """Geometry of a robot in one pose; all points in the world frame, m.

    Attributes:
        edges: (e, 2, 3) edges of the geoms' bounding boxes.
        links: (l, 2, 3) lines from each body to its child bodies.
        joints: Names of the n hinges.
        anchors: (n, 3) positions of the hinges.
        axes: (n, 3) unit vectors along the hinge axes.
        soles: Foot name to (k, 3) corners of its sole, in order.
        com: (3,) centre of mass.
        floor: Height of the lowest sole, or of the lowest corner.
    """

    edges: Array
    links: Array
    joints: tuple[str, ...]
    anchors: Array
    axes: Array
    soles: dict[str, Array]
    com: Array
    floor: float

    @property
    def points(self) -> Array:
        """All points (p, 3), for the extent of the robot."""
        every = [self.edges.reshape(-1, 3), self.links.reshape(-1, 3), self.anchors, self.com[None]]
        return np.concatenate(every)


def outline_of(robot: RobotDescription) -> Outline:
    """Return the outline of a robot in its stance."""
    model, data = in_stance(robot)
    soles = {foot.name: sole_outline(sole_points(model, data, foot)) for foot in robot.feet}
    found = {name: sole for name, sole in soles.items() if len(sole)}
    return _outline(model, data, found, root_of(model, robot))


def outline_of_model(model: mujoco.MjModel) -> Outline:
    """Return the outline of an MJCF in its zero pose, for a robot with an invalid robot.toml."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return _outline(model, data, {}, root_of(model))


def root_of(model: mujoco.MjModel, robot: RobotDescription | None = None) -> int:
    """Return the body that carries all others of a robot, without a table or a wall beside it.

    It is the robot's base; of a bare MJCF, the body below the world that carries its first joint.
    """
    if robot is not None:
        return int(model.body(robot.base).id)
    return int(model.body_rootid[model.jnt_bodyid[0]]) if model.njnt else 0


def sole_outline(points: Array) -> Array:
    """Return the corners (k, 3) of the horizontal hull of a sole, in order.

    Args:
        points: (8 g, 3) corners of the bounding boxes of a foot's g geoms, box by box, m.
    """
    if not len(points):
        return points
    faces = np.concatenate([_lower_face(box) for box in points.reshape(-1, 8, 3)])
    low = faces[faces[:, 2] < faces[:, 2].min() + FLAT]
    try:
        return low[ConvexHull(low[:, :2]).vertices]
    except (QhullError, ValueError):  # too few, or on a line
        return low


def _lower_face(box: Array) -> Array:
    """Return the corners (4, 3) of the lower face of a box (8, 3)."""
    bit = max((1, 2, 4), key=lambda bit: _steepness(box[bit] - box[0]))
    up = box[bit, 2] > box[0, 2]
    return box[[corner for corner in range(8) if bool(corner & bit) != up]]


def _steepness(edge: Array) -> float:
    return abs(float(edge[2])) / (float(np.linalg.norm(edge)) or 1.0)


def _outline(
    model: mujoco.MjModel, data: mujoco.MjData, soles: dict[str, Array], root: int
) -> Outline:
    hinges = np.flatnonzero(model.jnt_type == mjcf.HINGE)
    edges = _edges(model, data)
    low = np.concatenate([*soles.values()]) if soles else edges.reshape(-1, 3)
    return Outline(
        edges=edges,
        links=_links(model, data),
        joints=tuple(model.joint(j).name or f"joint {j}" for j in hinges),
        anchors=data.xanchor[hinges].copy(),
        axes=data.xaxis[hinges].copy(),
        soles=soles,
        com=data.subtree_com[root].copy(),
        floor=float(low[:, 2].min()) if len(low) else 0.0,
    )


def _edges(model: mujoco.MjModel, data: mujoco.MjData) -> Array:
    """Return the edges (e, 2, 3) of the bounding boxes of all geoms except floors."""
    geoms = np.flatnonzero(~np.isin(model.geom_type, FLOORS))
    boxes = [corners_of(model, data, int(geom))[EDGES] for geom in geoms]
    return np.concatenate(boxes) if boxes else np.zeros((0, 2, 3))


def _links(model: mujoco.MjModel, data: mujoco.MjData) -> Array:
    """Return the lines (l, 2, 3) from bodies to their parents, except the world."""
    hung = np.flatnonzero(model.body_parentid > 0)
    return np.stack((data.xpos[model.body_parentid[hung]], data.xpos[hung]), axis=1)
