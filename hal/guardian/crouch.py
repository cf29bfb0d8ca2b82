"""The guardian's crouch, for robots of which every joint can be read and still has torque."""

import time
from collections.abc import Sequence

import numpy as np

from windup.hal.geometry.smooth_step import smooth_step
from windup.hal.guard.guarded import CROUCH_SECONDS
from windup.hal.guardian.remote_bus import RemoteBus

PERIOD = 0.02
"""Time between two goals, s."""


def crouch(buses: Sequence[RemoteBus]) -> None:
    """Move the servos of a robot from their present positions to its crouch along a smoothstep.

    Raises:
        HardwareError: A servo cannot be read or has lost its torque, before or during the motion.
    """
    starts = [bus.hold_position() for bus in buses]
    ends = [np.array([bus.record.crouch[id] for id in bus.record.servos]) for bus in buses]
    began = time.monotonic()
    s = 0.0
    while s < 1.0:
        s = min((time.monotonic() - began) / CROUCH_SECONDS, 1.0)
        blend = smooth_step(s)
        for bus, start, end in zip(buses, starts, ends, strict=True):
            bus.send_goals(start + (end - start) * blend)
        time.sleep(PERIOD)
