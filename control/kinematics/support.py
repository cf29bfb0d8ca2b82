"""Support regions on the ground: a polygon of contact points, or Kenwright's capsule."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
import shapely
from shapely import LineString, MultiPoint, Point
from shapely.geometry.base import BaseGeometry
from shapely.ops import nearest_points

from windup.control.kinematics.computed_once import ComputedOnce
from windup.hal.joints import Array


@dataclass(frozen=True)
class SupportRegion:
    """A convex region of the ground in which the centre of pressure can be.

    Attributes:
        shape: The region in the world's x and y, m; empty if there is no contact.
    """

    shape: BaseGeometry

    @classmethod
    def hull(cls, points: Array) -> "SupportRegion":
        """Return the convex hull of contact points (p, 2) or (p, 3) m."""
        return cls(convex_hull(points[:, :2]))

    @classmethod
    def capsule(cls, feet: Array, radius: float) -> "SupportRegion":
        """Return the convex hull of circles of `radius` m around feet (k, 2).

        Kenwright 2012, section IV-A.2: a circle for one foot, a capsule for two.
        """
        return cls(convex_hull(feet[:, :2]).buffer(radius))

    @classmethod
    def rounded(cls, soles: Sequence[Array]) -> "SupportRegion":
        """Return the capsule whose circles have the soles' mean area; points (p, 3) m per sole."""
        hulls = [convex_hull(points[:, :2]) for points in soles]
        radius = sqrt(sum(hull.area for hull in hulls) / len(hulls) / pi)
        middles = np.array([[hull.centroid.x, hull.centroid.y] for hull in hulls])
        return cls.capsule(middles, radius)

    @ComputedOnce
    def _boundary(self) -> BaseGeometry:
        return self.shape.boundary

    def margin(self, point: Array) -> float:
        """Return the distance of `point` (2,) inside the edge, m; < 0 outside, -inf if empty."""
        if self.shape.is_empty:
            return -np.inf
        place = _point(point)
        away = self.shape.distance(place)
        return -away if away > 0.0 else self._boundary.distance(place)

    def nearest(self, point: Array) -> Array:
        """Return the point (2,) of the region that is nearest to `point` (2,)."""
        return nearest_point(self.shape, point)


def nearest_point(shape: BaseGeometry, point: Array) -> Array:
    """Return the point (2,) of `shape` nearest to `point` (2,); inside, that is `point` itself."""
    near, _ = nearest_points(shape, _point(point))
    return np.array([near.x, near.y])


def convex_hull(points: Array) -> BaseGeometry:
    """Return the convex hull of points (p, 2): that of a line through them, made faster."""
    if len(points) < 2:
        return MultiPoint(points).convex_hull
    line = shapely.linestrings(points)
    assert isinstance(line, LineString)
    return line.convex_hull


def _point(point: Array) -> Point:
    """Return a point (2,) or (3,) as Shapely has it; its constructor takes twice as long."""
    place = shapely.points(point[:2])
    assert isinstance(place, Point)
    return place
