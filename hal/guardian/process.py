"""The guardian process: watches the heartbeats of its host, and stops the robot if they end.

After a tick of the loop, the next heartbeat is due within 0.15 s. If it is missing, or if the host
does not see a request in its stop flag within 0.1 s, the host is made to print its stacks and is
killed; only then the stop policy runs, so that two programs never use one bus. The process ends
when the host has released it, or when the torque of every servo has been read back as off.
"""

import os
import resource
import select
import sys
import time
from contextlib import suppress
from enum import Enum
from math import inf
from pathlib import Path

import msgspec

from windup.hal.clock import PRIORITY
from windup.hal.guardian.host import Host
from windup.hal.guardian.order import HAND_OVER, IDLE, READY, RELEASE, SILENCE, TICK, Order
from windup.hal.guardian.signals import ignore_signals
from windup.hal.guardian.takeover import Takeover
from windup.hal.guardian.words import Words, standard_error
from windup.hal.in_words import in_words
from windup.hal.stopping.stop_flag import StopFlag

ABOVE = 5
"""Amount by which its real-time priority exceeds that of the loop."""
NICENESS = -15
"""Niceness if real-time scheduling is not permitted."""
OVERSLEPT = 0.02
"""Lateness of a wait that shows that the whole machine was stalled, s."""
SECOND_CHANCE = 0.05
"""Time granted to the host for its next heartbeat after such a stall, s."""

LOOK = 0.02
"""Maximum time between two looks at the stop flag, s."""
LAST_WORDS = 0.2
"""Maximum time to wait at the end until all messages are written, s."""
DYING = 0.02
"""Maximum time from a dying process closing its pipe to its end, s."""


class Ending(Enum):
    """Why the guardian stops watching."""

    RELEASED = "released"
    HANDED_OVER = "its program could not read its torque as off"
    DIED = "its program died"
    SILENT = "its program hangs"
    ASKED = "its program did not answer `windup stop`"
    CLOSED = "its program let go of its guardian"
    DEAF = "its guardian cannot hear its program"


def main() -> None:
    """Run the guardian: read the order from standard input, then heartbeats."""
    ignore_signals()
    _allow_files()
    words, orders = Words(standard_error()), sys.stdin.fileno()
    if (line := _first_line(orders)) is None:
        words.say("its program died before it had said what to guard")
    else:
        _guard(msgspec.json.decode(line, type=Order), orders, words)
    words.finish(LAST_WORDS)


def _guard(order: Order, orders: int, words: Words) -> None:
    """Watch the host, and stop the robot unless the host has released the guardian."""
    flag = StopFlag.open(Path(order.flag)) if order.flag else None
    host, takeover = Host(order.host), Takeover(order, words.say, flag)
    _go_first()
    os.write(sys.stdout.fileno(), READY)
    os.close(sys.stdout.fileno())
    try:
        ending, moved = watch(orders, host, flag)
    except Exception as error:  # only the guardian can stop the robot now
        words.say(in_words(error))
        ending, moved = Ending.DEAF, False
    if ending is Ending.RELEASED:
        return
    with suppress(Exception):
        if ending in (Ending.SILENT, Ending.ASKED, Ending.CLOSED, Ending.DEAF):
            host.kill()
    takeover.carry_out(ending.value, moved)
    if ending is not Ending.HANDED_OVER:
        takeover.wait_for(host)


def watch(orders: int, host: Host, flag: StopFlag | None = None) -> tuple[Ending, bool]:
    """Read heartbeats from a descriptor until there is a reason to stop watching.

    Args:
        orders: The descriptor.
        host: The host process.
        flag: Its stop flag, if it has one.

    Returns:
        The reason, and whether the first motion was complete; before it, the pose is arbitrary.
    """
    heard, patience, moved = time.monotonic(), SILENCE[IDLE], False
    poller = select.poll()
    for descriptor in (orders, *host.descriptors):
        poller.register(descriptor, select.POLLIN)
    longest = inf if flag is None else LOOK
    while flag is None or not flag.overdue():
        due = heard + patience
        wait = min(max(due - time.monotonic(), 0.0), longest)
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
        elif (late := time.monotonic() - due) > OVERSLEPT:
            heard, patience = time.monotonic(), SECOND_CHANCE
        elif late >= 0.0:
            return Ending.SILENT, moved
    return Ending.ASKED, moved


def _ending(data: bytes, host: Host) -> Ending | None:
    """Return the reason to stop watching that the host's bytes give, or None for heartbeats."""
    if RELEASE in data:
        return Ending.RELEASED
    if HAND_OVER in data:
        return Ending.HANDED_OVER
    if data:
        return None
    return Ending.DIED if host.wait(DYING) else Ending.CLOSED


def _first_line(orders: int) -> bytes | None:
    """Read the order and the heartbeat after it; return the order.

    Returns None if the host ends before that.
    """
    text = b""
    while not text.endswith(b"\n" + IDLE):
        chunk = os.read(orders, 1)
        if not chunk:
            return None
        text += chunk
    return text[:-1]


def _allow_files() -> None:
    """Raise the limit of open files to its maximum: the host may have lowered the soft limit."""
    with suppress(OSError, ValueError):
        most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))


def _go_first() -> None:
    """Set a higher priority than the loop: a loop that spins must not starve this process."""
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(PRIORITY + ABOVE))
        return
    with suppress(OSError):
        os.nice(NICENESS)
