"""Support regions on the ground: a polygon of contact points, or Kenwright's capsule."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from shapely import MultiPoint, Point
from shapely.geometry.base import BaseGeometry
from shapely.ops import nearest_points

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
        return cls(MultiPoint(points[:, :2]).convex_hull)

    @classmethod
    def capsule(cls, feet: Array, radius: float) -> "SupportRegion":
        """Return the convex hull of circles of `radius` m around feet (k, 2).

        Kenwright 2012, section IV-A.2: a circle for one foot, a capsule for two.
        """
        return cls(MultiPoint(feet[:, :2]).convex_hull.buffer(radius))

    @classmethod
    def rounded(cls, soles: Sequence[Array]) -> "SupportRegion":
        """Return the capsule whose circles have the soles' mean area; points (p, 3) m per sole."""
        hulls = [MultiPoint(points[:, :2]).convex_hull for points in soles]
        radius = sqrt(sum(hull.area for hull in hulls) / len(hulls) / pi)
        middles = np.array([[hull.centroid.x, hull.centroid.y] for hull in hulls])
        return cls.capsule(middles, radius)

    def margin(self, point: Array) -> float:
        """Return the distance of `point` (2,) inside the edge, m; < 0 outside, -inf if empty."""
        if self.shape.is_empty:
            return -np.inf
        place = Point(point[0], point[1])
        away = self.shape.distance(place)
        return -away if away > 0.0 else self.shape.boundary.distance(place)

    def nearest(self, point: Array) -> Array:
        """Return the point (2,) of the region that is nearest to `point` (2,)."""
        return nearest_point(self.shape, point)


def nearest_point(shape: BaseGeometry, point: Array) -> Array:
    """Return the point (2,) of `shape` nearest to `point` (2,); inside, that is `point` itself."""
    near, _ = nearest_points(shape, Point(point[0], point[1]))
    return np.array([near.x, near.y])
