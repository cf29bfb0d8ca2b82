"""Warnings about the stance of a robot: sides of feet, soles, balance and fall criterion."""

from collections.abc import Iterator
from itertools import pairwise

import mujoco
import numpy as np

from windup.hal.errors import ConfigError
from windup.hal.joints import Array
from windup.robots.description import RobotDescription
from windup.robots.records import Foot

LEVEL = 0.01
"""Tolerance of the heights of soles and of the sites on them, m."""
DIRECTIONS = np.radians(np.arange(0.0, 360.0, 2.0))
AROUND = np.column_stack((np.cos(DIRECTIONS), np.sin(DIRECTIONS)))


def posture_warnings(
    robot: RobotDescription, model: mujoco.MjModel, data: mujoco.MjData
) -> Iterator[str]:
    """Yield warnings about a robot in its stance.

    Args:
        robot: The robot.
        model: Its model.
        data: Its state in the stance, with kinematics and centres of mass computed.
    """
    if robot.fixed or not robot.feet:
        return
    yield from _sides(robot, data)
    yield from _soles(robot, model, data)
    yield from _balance(robot, model, data)
    yield from _fall(robot, model, data)


def sole_points(model: mujoco.MjModel, data: mujoco.MjData, foot: Foot) -> Array:
    """Return the corners (k, 3) of the bounding boxes of a foot's colliding geoms, m."""
    solid = (model.geom_contype > 0) | (model.geom_conaffinity > 0)
    geoms = np.flatnonzero(solid & (model.geom_bodyid == model.body(foot.body).id))
    corners = [corners_of(model, data, int(geom)) for geom in geoms]
    return np.concatenate(corners) if corners else np.zeros((0, 3))


def corners_of(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> Array:
    """Return the corners (8, 3) of a geom's own bounding box in the world frame, m."""
    signs = np.array(np.meshgrid(*[[-1.0, 1.0]] * 3, indexing="ij")).reshape(3, -1).T
    local = model.geom_aabb[geom, :3] + signs * model.geom_aabb[geom, 3:]
    return data.geom_xpos[geom] + local @ data.geom_xmat[geom].reshape(3, 3).T


def tilt_of_sole(model: mujoco.MjModel, data: mujoco.MjData, foot: Foot) -> float | None:
    """Return the tilt of the lowest face that the site of a foot lies on, rad; None without."""
    solid = (model.geom_contype > 0) | (model.geom_conaffinity > 0)
    site = data.site(foot.site).xpos
    for geom in np.flatnonzero(solid & (model.geom_bodyid == model.body(foot.body).id)):
        axes = data.geom_xmat[geom].reshape(3, 3)
        down = int(np.abs(axes[2]).argmax())
        sign = np.sign(axes[2, down])
        local = axes.T @ (site - data.geom_xpos[geom]) - model.geom_aabb[geom, :3]
        if abs(sign * local[down] + model.geom_aabb[geom, 3 + down]) < LEVEL:
            return float(np.arccos(min(abs(axes[2, down]), 1.0)))
    return None


def balance_margin(points: Array, com: Array) -> float:
    """Return the distance of `com` (2,) from the edge of the hull of `points` (k, 2), m.

    It is negative outside the hull.

    >>> round(balance_margin(np.array([[1.0, 1], [1, -1], [-1, 1], [-1, -1]]), np.zeros(2)), 3)
    1.0
    """
    return float((AROUND @ (points - com).T).max(axis=1).min())


def _sides(robot: RobotDescription, data: mujoco.MjData) -> Iterator[str]:
    """Yield warnings about missing or wrong sides of two feet, and a robot without symmetry."""
    if len(robot.feet) != 2:
        return
    unsaid = [repr(foot.name) for foot in robot.feet if not foot.side]
    if unsaid:
        yield f'no side of foot {" and ".join(unsaid)}: give side = "left" or "right" to walk'
        return
    left, right = sorted(robot.feet, key=lambda foot: foot.side)
    gap = float(data.site(left.site).xpos[1] - data.site(right.site).xpos[1])
    if gap <= 0.0:
        yield (
            f"foot {left.name!r} is called left and is {-gap:.3g} m to the right of "
            f"{right.name!r}: x points forward and y to the left; change `side` or the MJCF"
        )
    try:
        robot.mirror  # noqa: B018 - a property that raises
    except ConfigError as error:
        yield f"left and right differ: {error}; gaits with `mirror` or perturbations need that"


def _soles(robot: RobotDescription, model: mujoco.MjModel, data: mujoco.MjData) -> Iterator[str]:
    """Yield warnings about sites that are not on the soles, and soles of different heights."""
    for foot in robot.feet:
        points = sole_points(model, data, foot)
        above = float(data.site(foot.site).xpos[2] - points[:, 2].min()) if len(points) else 0.0
        if abs(above) > LEVEL and (tilt := tilt_of_sole(model, data, foot)) is not None:
            yield (
                f"in the stance the sole of foot {foot.name!r} is tilted by "
                f"{np.degrees(tilt):.0f} degrees: correct the angles of its leg, or their signs"
            )
        elif abs(above) > LEVEL:
            where = "above" if above > 0.0 else "below"
            yield (
                f"site {foot.site!r} is {1e3 * abs(above):.0f} mm {where} the lowest point of "
                f"foot {foot.name!r}: put it in the middle of the sole"
            )
    heights = sorted((float(data.site(foot.site).xpos[2]), foot.name) for foot in robot.feet)
    for (low, one), (high, other) in pairwise(heights):
        if high - low > LEVEL:
            off = 1e3 * (high - low)
            yield f"in the stance foot {other!r} is {off:.0f} mm higher than {one!r}"


def _balance(robot: RobotDescription, model: mujoco.MjModel, data: mujoco.MjData) -> Iterator[str]:
    """Yield a warning if the centre of mass is not above the support polygon."""
    points = np.concatenate([sole_points(model, data, foot) for foot in robot.feet])
    if not len(points):
        return
    com = data.subtree_com[model.body(robot.base).id]
    outside = -balance_margin(points[:, :2], com[:2])
    if outside > 0.0:
        ahead, left = com[:2] - points[:, :2].mean(axis=0)
        yield (
            f"in the stance the centre of mass is {1e3 * outside:.0f} mm outside of the soles "
            f"({1e3 * ahead:+.0f} mm forward and {1e3 * left:+.0f} mm to the left of their "
            "middle): it topples"
        )


def _fall(robot: RobotDescription, model: mujoco.MjModel, data: mujoco.MjData) -> Iterator[str]:
    """Yield warnings if the stance itself meets the fall criterion."""
    ground = min(float(data.site(foot.site).xpos[2]) for foot in robot.feet)
    height = float(data.body(robot.base).xpos[2]) - ground
    if height <= robot.fall.height:
        yield (
            f"fall.height {robot.fall.height:g} m: in the stance body {robot.base!r} is "
            f"{height:.3f} m above the soles, so the robot counts as fallen; give half of that"
        )
    up = data.body(robot.torso).xmat[8]
    tilt = float(np.arccos(np.clip(up, -1.0, 1.0)))
    if tilt >= robot.fall.tilt:
        yield (
            f"fall.tilt {robot.fall.tilt:g} rad: in the stance the z axis of body "
            f"{robot.torso!r} leans by {tilt:.2f} rad; z has to point up"
        )
