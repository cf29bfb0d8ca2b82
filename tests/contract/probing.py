"""What the contract has to know of a backend to ask it fair questions."""

import re
from itertools import count
from typing import Final

import numpy as np

from windup.hal.backend import Backend
from windup.hal.joints import Array
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.robots import load_robot
from windup.tools.robot.stack import servo_backend

TICK: Final = 0.008
"""Between two ticks, s."""
_worlds = count()
COUNT: Final = 2.0 * np.pi / 4096
FREE: Final = re.compile("sho|elbow|head|neck|^ankle")  # they bear no weight, in all robots


def resolution(backend: Backend) -> Array:
    """Return the count (n,) of each joint's encoder, rad; a twin is as fine as a 4096th."""
    if not isinstance(backend, ServoBackend):
        return np.full(len(backend.joints), COUNT)
    turns = [mount.ratio * mount.model.counts_per_rev for mount in backend.mounts]
    return 2.0 * np.pi / np.array(turns)


def free(backend: Backend) -> list[str]:
    """Return the names of the joints that bear no weight; every robot has some."""
    names = [name for name in backend.joints.names if FREE.search(name)]
    assert names
    return names


def wired(name: str) -> Backend:
    """Return a robot behind its emulated servo bus, in a world of its own."""
    world = f"contract-{next(_worlds)}"
    return servo_backend(load_robot(name), f"twin://{name}?world={world}&return_delay=0")
