"""Possible contact points of the soles, and their motion relative to the base."""

from collections.abc import Sequence
from itertools import pairwise, product

import mujoco
import numpy as np
import numpy.typing as npt

from windup.hal.contacts import ContactSensors
from windup.hal.errors import UsageError
from windup.hal.joints import Array

Indices = npt.NDArray[np.intp]

IDENTITY = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
UP = np.array([0.0, 0.0, 1.0])
GEOM = mujoco.mjtGeom


class Soles:
    """The p points of the feet that can bear load, in the base frame.

    A box contributes its eight corners, a sphere its centre and a capsule its two end centres;
    spheres and capsules touch the ground one radius below these.

    Args:
        model: The robot alone: a free joint, then n hinges in MJCF order.
        feet: Names of the feet's bodies, in the order of `contacts.feet`.
        contacts: The contact sensors; each point belongs to the nearest one of its foot.

    Attributes:
        foot: (p,) index of each point's foot.
        sensor: (p,) index of each point's contact sensor, -1 where the foot has none.
        rows: For each foot the rows of its points.
        members: (feet, p) 1 if a point belongs to a foot, else 0.
        position: (p, 3) contact points in the base frame, m.
        rotation: (feet, 3) angular velocities of the feet relative to the base, base frame, rad/s.
        heights: (p,) heights of the points above the base's origin, along the vertical, m.
    """

    def __init__(
        self, model: mujoco.MjModel, feet: Sequence[str], contacts: ContactSensors
    ) -> None:
        self._model, self._data = model, mujoco.MjData(model)
        self._data.qpos[:7] = IDENTITY
        self._bodies = np.array([model.body(name).id for name in feet], dtype=np.intp)
        points, radii, foot = [], [], []
        for index, body in enumerate(self._bodies):
            found = _points(model, int(body))
            if not found:
                raise UsageError(f"foot {feet[index]!r} has no box, sphere or capsule that touches")
            points += [point for point, _ in found]
            radii += [radius for _, radius in found]
            foot += [index] * len(found)
        self._local, self._radius = np.array(points)[:, :, None], np.array(radii)[:, None]
        self._round = any(radii)
        self.foot = np.array(foot, dtype=np.intp)
        ends = np.cumsum([0, *np.bincount(self.foot)]).tolist()
        self.rows = [slice(begin, end) for begin, end in pairwise(ends)]
        self._of_point = self._bodies[self.foot]
        self.members = (self.foot == np.arange(len(feet))[:, None]).astype(float)
        self.sensor = self._nearest(contacts)
        self.position = np.zeros((len(foot), 3))
        self.rotation = np.zeros((len(feet), 3))
        self.heights = np.zeros(len(foot))
        # Views, looked up once: to look one up takes as long as to copy it.
        self._joints, self._rates = self._data.qpos[7:], self._data.qvel[6:]
        self._xpos, self._xmat, self._cvel = self._data.xpos, self._data.xmat, self._data.cvel
        root = int(model.body_rootid[self._bodies[0]])
        self._pivot = self._data.subtree_com[root]

    def update(self, position: Array, velocity: Array, up: Array) -> None:
        """Update all attributes for the present joint state.

        Args:
            position: (n,) joint positions, rad.
            velocity: (n,) joint velocities, rad/s.
            up: (3,) unit vertical in the base frame.
        """
        data = self._data
        self._joints[:] = position
        self._rates[:] = velocity
        mujoco.mj_kinematics(self._model, data)
        mujoco.mj_comPos(self._model, data)
        mujoco.mj_comVel(self._model, data)
        self.position = self._points(self._xpos, self._xmat, up)
        self.heights = self.position @ up
        twist = self._cvel[self._bodies]
        self.rotation = twist[:, :3]
        self._linear = twist[:, 3:]

    def seen(self, position: Array, axes: Array) -> Array:
        """Return the points (p, 3) in the world frame, m.

        Args:
            position: (bodies, 3) positions of all bodies of the model, m.
            axes: (bodies, 9) their rotation matrices, row by row.
        """
        return self._points(position, axes, UP)

    def _points(self, position: Array, axes: Array, up: Array) -> Array:
        frames = axes[self._bodies].reshape(-1, 3, 3)
        turned = (frames[self.foot] @ self._local)[:, :, 0]
        points = turned + position[self._of_point]
        return points - self._radius * up if self._round else points

    def flow(self, weights: Array) -> tuple[Array, Array]:
        """Return each foot's weighted sums of point positions and velocities.

        Args:
            weights: (p,) weight of each point.

        Returns:
            (feet, 3) m and (feet, 3) m/s relative to the base, in the base frame.
        """
        place = (self.members * weights) @ self.position
        share = (self.members @ weights)[:, None]
        arm = place - share * self._pivot
        return place, share * self._linear + cross(self.rotation, arm)

    def _nearest(self, contacts: ContactSensors) -> Indices:
        """Return for each point (p,) the index of its foot's nearest sensor, -1 without one."""
        model, data = self._model, mujoco.MjData(self._model)
        mujoco.mj_kinematics(model, data)
        nearest = np.full(len(self.foot), -1, dtype=np.intp)
        for row, names in enumerate(contacts.feet.values()):
            if not names:
                continue
            sites = data.site_xpos[[int(model.sensor(name).objid[0]) for name in names]]
            mine = np.flatnonzero(self.foot == row)
            body = self._bodies[row]
            places = data.xpos[body] + self._local[mine, :, 0] @ data.xmat[body].reshape(3, 3).T
            away = np.linalg.norm(places[:, None] - sites[None], axis=2)
            order = np.array([contacts.names.index(name) for name in names])
            nearest[mine] = order[away.argmin(axis=1)]
        return nearest


def spin(rate: Array) -> Array:
    """Return the cross-product matrix (3, 3) S of `rate` (3,), with S v = rate x v."""
    x, y, z = rate.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def cross(a: Array, b: Array) -> Array:
    """Return a x b in the shape (..., 3) of b; `np.cross` takes ten times as long for few rows."""
    c = np.empty(b.shape)
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    c[..., 0] = ay * bz - az * by
    c[..., 1] = az * bx - ax * bz
    c[..., 2] = ax * by - ay * bx
    return c


def _points(model: mujoco.MjModel, body: int) -> list[tuple[Array, float]]:
    """Return points (3,) and radii of the colliding geoms of `body`, in its frame, m."""
    found: list[tuple[Array, float]] = []
    first = int(model.body_geomadr[body])
    for geom in range(first, first + int(model.body_geomnum[body])):
        if not (model.geom_contype[geom] or model.geom_conaffinity[geom]):
            continue
        size, kind = model.geom_size[geom], model.geom_type[geom]
        frame = np.empty(9)
        mujoco.mju_quat2Mat(frame, model.geom_quat[geom])
        if kind == GEOM.mjGEOM_BOX:
            local = np.array(list(product((-1.0, 1.0), repeat=3))) * size
            radius = 0.0
        elif kind == GEOM.mjGEOM_SPHERE:
            local, radius = np.zeros((1, 3)), float(size[0])
        elif kind == GEOM.mjGEOM_CAPSULE:
            local, radius = np.array([[0.0, 0.0, -size[1]], [0.0, 0.0, size[1]]]), float(size[0])
        else:
            continue
        found += [(point, radius) for point in model.geom_pos[geom] + local @ frame.reshape(3, 3).T]
    return found
