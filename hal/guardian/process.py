"""The guardian process: wait for the host's end or its silence, then stop the robot.

A heartbeat is due 0.15 s after a tick of the loop. On silence the host prints where it hangs and is
killed; only then does the stop policy run, so that two programs never talk on one bus. The process
ends when the host has released it, or when the torque of every servo has been read as off.
"""

import os
import select
import sys
import time
from contextlib import suppress
from enum import Enum

import msgspec

from hal.clock import PRIORITY
from hal.guardian.host import Host
from hal.guardian.order import HAND_OVER, IDLE, READY, RELEASE, SILENCE, Order
from hal.guardian.takeover import Takeover

ABOVE = 5
"""By how much it precedes the loop among real-time processes."""
NICENESS = -15
"""Where it may not be one."""
OVERSLEPT = 0.02
"""A wait that ends so much late shows that the whole machine stood still, s."""
SECOND_CHANCE = 0.05
"""What the host gets for its heartbeat then, s."""

DYING = 0.02
"""From a process letting go of its pipe to its end, where it dies, s."""


class Ending(Enum):
    """Why the guardian stops watching."""

    RELEASED = "released"
    HANDED_OVER = "its program gave it up"
    DIED = "its program died"
    SILENT = "its program hangs"
    CLOSED = "its program let go of its guardian"


def main() -> None:
    """Be the guardian: the order comes on standard input, then heartbeats."""
    orders = sys.stdin.fileno()
    line = _first_line(orders)
    order = msgspec.json.decode(line, type=Order)
    host, takeover = Host(order.host), Takeover(order)
    _go_first()
    os.write(sys.stdout.fileno(), READY)
    os.close(sys.stdout.fileno())
    ending = watch(orders, host)
    if ending is Ending.RELEASED:
        return
    takeover.begin(ending.value)
    if ending in (Ending.SILENT, Ending.CLOSED):
        host.kill()
    takeover.carry_out(host, wait_for_host=ending is not Ending.HANDED_OVER)


def watch(orders: int, host: Host) -> Ending:
    """Read heartbeats from a descriptor until there is a reason to stop watching."""
    heard, patience = time.monotonic(), SILENCE[IDLE]
    while True:
        due = heard + patience
        wait = max(due - time.monotonic(), 0.0)
        ready, _, _ = select.select([orders, *host.descriptors], [], [], wait)
        if orders in ready:
            data = os.read(orders, 4096)
            if (ending := _ending(data, host)) is not None:
                return ending
            heard, patience = time.monotonic(), SILENCE[data[-1:]]
        elif ready:
            return Ending.DIED
        elif time.monotonic() - due > OVERSLEPT:
            heard, patience = time.monotonic(), SECOND_CHANCE
        else:
            return Ending.SILENT


def _ending(data: bytes, host: Host) -> Ending | None:
    """Return what the host's bytes end, or None for heartbeats."""
    if RELEASE in data:
        return Ending.RELEASED
    if HAND_OVER in data:
        return Ending.HANDED_OVER
    if data:
        return None
    return Ending.DIED if host.wait(DYING) else Ending.CLOSED


def _first_line(orders: int) -> bytes:
    """Return the order, and swallow the heartbeat behind it: reading it shows that they arrive."""
    text = b""
    while not text.endswith(b"\n" + IDLE):
        chunk = os.read(orders, 1)
        if not chunk:
            sys.exit("the host of this guardian died before it had told it what to do")
        text += chunk
    return text[:-1]


def _go_first() -> None:
    """Run before the loop: one that spins must not keep this process from the processor."""
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(PRIORITY + ABOVE))
        return
    with suppress(OSError):
        os.nice(NICENESS)
