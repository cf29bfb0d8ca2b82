"""The guardian process: wait for the host's end or its silence, then stop the robot.

A heartbeat is due 0.15 s after a tick of the loop. On silence the host prints where it hangs and is
killed; only then does the stop policy run, so that two programs never talk on one bus. The process
ends when the host has released it, or when the torque of every servo has been read as off.
"""

import os
import resource
import select
import sys
import time
from contextlib import suppress
from enum import Enum

import msgspec

from windup.hal.clock import PRIORITY
from windup.hal.guardian.host import Host
from windup.hal.guardian.order import HAND_OVER, IDLE, READY, RELEASE, SILENCE, TICK, Order
from windup.hal.guardian.signals import ignore_signals
from windup.hal.guardian.takeover import Takeover
from windup.hal.guardian.words import Words, standard_error
from windup.hal.in_words import in_words

ABOVE = 5
"""By how much it precedes the loop among real-time processes."""
NICENESS = -15
"""Where it may not be one."""
OVERSLEPT = 0.02
"""A wait that ends so much late shows that the whole machine stood still, s."""
SECOND_CHANCE = 0.05
"""What the host gets for its heartbeat then, s."""

LAST_WORDS = 0.2
"""How long it waits in the end for who reads what it says, s."""
DYING = 0.02
"""From a process letting go of its pipe to its end, where it dies, s."""


class Ending(Enum):
    """Why the guardian stops watching."""

    RELEASED = "released"
    HANDED_OVER = "its program could not read its torque as off"
    DIED = "its program died"
    SILENT = "its program hangs"
    CLOSED = "its program let go of its guardian"
    DEAF = "its guardian cannot hear its program"


def main() -> None:
    """Be the guardian: the order comes on standard input, then heartbeats."""
    ignore_signals()
    _allow_files()
    words, orders = Words(standard_error()), sys.stdin.fileno()
    if (line := _first_line(orders)) is None:
        words.say("its program died before it had said what to guard")
    else:
        _guard(msgspec.json.decode(line, type=Order), orders, words)
    words.finish(LAST_WORDS)


def _guard(order: Order, orders: int, words: Words) -> None:
    """Watch the host, and stop its robot unless it has done so itself."""
    host, takeover = Host(order.host), Takeover(order, words.say)
    _go_first()
    os.write(sys.stdout.fileno(), READY)
    os.close(sys.stdout.fileno())
    try:
        ending, moved = watch(orders, host)
    except Exception as error:  # nobody else is left to stop the robot
        words.say(in_words(error))
        ending, moved = Ending.DEAF, False
    if ending is Ending.RELEASED:
        return
    with suppress(Exception):
        if ending in (Ending.SILENT, Ending.CLOSED, Ending.DEAF):
            host.kill()
    takeover.carry_out(ending.value, moved)
    if ending is not Ending.HANDED_OVER:
        takeover.wait_for(host)


def watch(orders: int, host: Host) -> tuple[Ending, bool]:
    """Read heartbeats from a descriptor until there is a reason to stop watching.

    Returns:
        The reason, and whether the robot has made its first motion: before, it may be anywhere.
    """
    heard, patience, moved = time.monotonic(), SILENCE[IDLE], False
    poller = select.poll()
    for descriptor in (orders, *host.descriptors):
        poller.register(descriptor, select.POLLIN)
    while True:
        due = heard + patience
        wait = max(due - time.monotonic(), 0.0)
        ready = [descriptor for descriptor, _ in poller.poll(wait * 1e3)]
        if orders in ready:
            data = os.read(orders, 4096)
            if (ending := _ending(data, host)) is not None:
                return ending, moved
            if ticks := data.replace(IDLE, b""):
                moved = ticks.endswith(TICK)
            heard, patience = time.monotonic(), SILENCE[data[-1:]]
        elif ready:
            return Ending.DIED, moved
        elif time.monotonic() - due > OVERSLEPT:
            heard, patience = time.monotonic(), SECOND_CHANCE
        else:
            return Ending.SILENT, moved


def _ending(data: bytes, host: Host) -> Ending | None:
    """Return what the host's bytes end, or None for heartbeats."""
    if RELEASE in data:
        return Ending.RELEASED
    if HAND_OVER in data:
        return Ending.HANDED_OVER
    if data:
        return None
    return Ending.DIED if host.wait(DYING) else Ending.CLOSED


def _first_line(orders: int) -> bytes | None:
    """Return the order, and swallow the heartbeat behind it: reading it shows that they arrive.

    None if the host ends before that.
    """
    text = b""
    while not text.endswith(b"\n" + IDLE):
        chunk = os.read(orders, 1)
        if not chunk:
            return None
        text += chunk
    return text[:-1]


def _allow_files() -> None:
    """Have as many open files as may be: a host with a low limit must not limit this process."""
    with suppress(OSError, ValueError):
        most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))


def _go_first() -> None:
    """Run before the loop: one that spins must not keep this process from the processor."""
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(PRIORITY + ABOVE))
        return
    with suppress(OSError):
        os.nice(NICENESS)
