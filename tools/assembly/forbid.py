"""`--forbid`: ground where no foot may come down, as people write it."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from shapely import Point, Polygon, box
from shapely.geometry.base import BaseGeometry

from windup.hal.errors import UsageError
from windup.hal.ranges import Range, read_number

NEAR: Final = Range(-1_000.0, 1_000.0, "m")
FORMS: Final = (
    "X,Y,R (circle), X,Y,W,H (rectangle, X,Y its middle) or X1,Y1,X2,Y2,X3,Y3,.. (polygon)"
)


def forbidden(texts: Sequence[str]) -> list[BaseGeometry]:
    """Return regions of the ground, m.

    >>> forbidden(["1,0,0.5,2"])[0].bounds
    (0.75, -1.0, 1.25, 1.0)

    Raises:
        UsageError: One is written in another way, or has no area.
    """
    return [_region(text) for text in texts]


def _region(text: str) -> BaseGeometry:
    words = text.split(",")
    if len(words) < 3 or len(words) == 5:
        raise UsageError(f"--forbid {text}: write {FORMS}, in m")
    numbers = [read_number(f"--forbid {text}", word, NEAR) for word in words]
    region = _shape(text, numbers)
    if not region.is_valid or region.area <= 0.0:
        raise UsageError(f"--forbid {text}: it has no area, or its border crosses itself")
    return region


def _shape(text: str, numbers: list[float]) -> BaseGeometry:
    if len(numbers) == 3:
        return Point(numbers[:2]).buffer(max(numbers[2], 0.0))
    if len(numbers) == 4:
        x, y, wide, deep = numbers
        if min(wide, deep) <= 0.0:
            raise UsageError(f"--forbid {text}: give W and H above 0")
        return box(x - wide / 2.0, y - deep / 2.0, x + wide / 2.0, y + deep / 2.0)
    if len(numbers) % 2:
        raise UsageError(f"--forbid {text}: a polygon has as many X as Y")
    return Polygon(np.reshape(numbers, (-1, 2)))
