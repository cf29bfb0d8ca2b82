"""Servos that the guardian holds where they are, and the reasons to let go of them."""

import time
from collections.abc import Sequence

from windup.hal.guardian.remote_bus import RemoteBus

PERIOD = 0.2
"""Between two looks at heat and supply, s."""
AGAIN = 3
"""Looks in a row that have to agree: a weak checksum passes a wrong byte now and then."""


def hold(buses: Sequence[RemoteBus], seconds: float) -> str | None:
    """Hold servos that have been told to stay; return what asks for their torque to go off.

    Args:
        buses: The robot's buses.
        seconds: How long at most, s; None is returned then.

    Raises:
        HardwareError: A port is gone.
    """
    until, doubts = time.monotonic() + seconds, 0
    while time.monotonic() < until:
        time.sleep(PERIOD)
        why = next((why for bus in buses if (why := bus.complaint())), None)
        doubts = 0 if why is None else doubts + 1
        if doubts == AGAIN:
            return why
    return None
