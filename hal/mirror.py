"""Mirror images: converts joint values and names of one side of the robot to the other."""

import re
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from windup.hal.joints import Array

Side = Literal["left", "right"]
SIDE_WORDS = (("l", "r"), ("left", "right"))
"""How names say a side: the left word and the right one."""


@dataclass(frozen=True, eq=False)
class Mirror:
    """Mirror image across the robot's own plane y = 0.

    Attributes:
        perm: (n,) index of each joint's partner; a midline joint is its own partner.
        sign: (n,) +1 or -1, from the directions of the two joint axes.
    """

    perm: npt.NDArray[np.intp]
    sign: Array

    def __call__(self, values: Array) -> Array:
        """Return the mirror image of joint positions, velocities or torques (..., n)."""
        return self.sign * values[..., self.perm]


def other_side(name: str) -> str:
    """Return the name of the same part on the other side.

    >>> other_side("l_knee"), other_side("right_foot"), other_side("neck")
    ('r_knee', 'left_foot', 'neck')
    """
    for left, right in ((f"{one}_", f"{other}_") for one, other in SIDE_WORDS):
        if name.startswith(left):
            return right + name.removeprefix(left)
        if name.startswith(right):
            return left + name.removeprefix(right)
    return name


def side_of(name: str) -> Side | Literal[""]:
    """Return the side that is part of a name, or "" if it contains neither or both.

    >>> side_of("left_foot"), side_of("foot.R"), side_of("leg"), side_of("link_1")
    ('left', 'right', '', '')
    """
    words = set(re.split(r"[^a-z]+", name.lower()))
    left, right = (any(word in words for word in pair) for pair in zip(*SIDE_WORDS, strict=True))
    if left == right:
        return ""
    return "left" if left else "right"
