"""Holds the servos at their pose for the guardian, and finds reasons to end the hold."""

import time
from collections.abc import Sequence

from windup.hal.guardian.remote_bus import RemoteBus

PERIOD = 0.2
"""Period of the checks of temperature and supply, s."""
CONSECUTIVE = 3
"""Consecutive checks that have to fail: a weak checksum sometimes passes a wrong byte."""


def hold(buses: Sequence[RemoteBus], seconds: float) -> str | None:
    """Monitor servos that hold their pose; return the reason to switch torque off.

    Args:
        buses: The robot's buses.
        seconds: Maximum time, s; after it, None is returned.

    Raises:
        HardwareError: A port is lost.
    """
    until, doubts = time.monotonic() + seconds, 0
    while time.monotonic() < until:
        time.sleep(PERIOD)
        why = next((why for bus in buses if (why := bus.health_problem())), None)
        doubts = 0 if why is None else doubts + 1
        if doubts == CONSECUTIVE:
            return why
    return None
