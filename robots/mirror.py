"""The left-right mirror map of a robot, from the names and axes of its joints."""

import numpy as np

from windup.hal.errors import ConfigError
from windup.hal.joints import Array
from windup.hal.mirror import Mirror, other_side


def mirror_map(names: tuple[str, ...], axes: Array) -> Mirror:
    """Return the mirror of joints `names` with `axes` (n, 3) in the base frame, zero pose.

    A rotation by q about (x, y, z), mirrored at the plane y = 0, is a rotation by q about
    (-x, y, -z): if that is the partner's axis the sign is +1, if it is the opposite, -1.

    Raises:
        ConfigError: A joint has no partner, or one with a different axis.
    """
    perm = np.array([_partner_index(names, name) for name in names], dtype=np.intp)
    cosine = np.sum(axes[perm] * axes * [-1.0, 1.0, -1.0], axis=1)
    crooked = np.flatnonzero(np.abs(cosine) < 1.0 - 1e-6)
    if crooked.size:
        name = names[crooked[0]]
        raise ConfigError(f"joint {name!r} is not the mirror image of {other_side(name)!r}")
    return Mirror(perm, np.sign(cosine))


def _partner_index(names: tuple[str, ...], name: str) -> int:
    other = other_side(name)
    if other not in names:
        raise ConfigError(f"joint {name!r} has no partner {other!r} to mirror")
    return names.index(other)
