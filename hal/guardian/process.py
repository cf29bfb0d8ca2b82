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
from windup.hal.error_text import error_text
from windup.hal.guardian.host import Host
from windup.hal.guardian.message_writer import MessageWriter, standard_error
from windup.hal.guardian.order import (
    HAND_OVER,
    IDLE,
    MAX_SILENCE,
    READY,
    RELEASE,
    TICK,
    GuardianOrder,
)
from windup.hal.guardian.signals import ignore_signals
from windup.hal.guardian.takeover import Takeover
from windup.hal.stopping.stop_flag import StopFlag

PRIORITY_MARGIN = 5
"""Amount by which its real-time priority exceeds that of the loop."""
NICENESS = -15
"""Niceness if real-time scheduling is not permitted."""
STALL_TIME = 0.02
"""Lateness of a wait that shows that the whole machine was stalled, s."""
STALL_GRACE = 0.05
"""Time granted to the host for its next heartbeat after such a stall, s."""

LOOK_PERIOD = 0.02
"""Maximum time between two looks at the stop flag, s."""
MESSAGE_TIME = 0.2
"""Maximum time to wait at the end until all messages are written, s."""
EXIT_TIME = 0.02
"""Maximum time from a dying process closing its pipe to its end, s."""


class StopReason(Enum):
    """Why the guardian stops watching."""

    RELEASED = "released"
    HANDED_OVER = "the program could not read torque back as off"
    DIED = "the program died"
    SILENT = "the program hangs"
    IGNORED_STOP = "the program did not answer `windup stop`"
    CLOSED = "the program closed the pipe to its guardian"
    WATCH_FAILED = "the guardian failed to read the heartbeats"


KILLED = {
    StopReason.SILENT,
    StopReason.IGNORED_STOP,
    StopReason.CLOSED,
    StopReason.WATCH_FAILED,
}
"""Reasons for which the host is killed before the robot is stopped."""


def main() -> None:
    """Run the guardian: read the order from standard input, then heartbeats."""
    ignore_signals()
    _allow_files()
    writer, orders = MessageWriter(standard_error()), sys.stdin.fileno()
    if (line := _first_line(orders)) is None:
        writer.write_line("the program died before it had sent the list of buses")
    else:
        _guard(msgspec.json.decode(line, type=GuardianOrder), orders, writer)
    writer.finish(MESSAGE_TIME)


def _guard(order: GuardianOrder, orders: int, writer: MessageWriter) -> None:
    """Watch the host, and stop the robot unless the host has released the guardian."""
    flag = StopFlag.open(Path(order.flag)) if order.flag else None
    host, takeover = Host(order.host), Takeover(order, writer.write_line, flag)
    _raise_priority()
    os.write(sys.stdout.fileno(), READY)
    os.close(sys.stdout.fileno())
    try:
        ending, moved = watch(orders, host, flag)
    except Exception as error:  # only the guardian can stop the robot now
        writer.write_line(error_text(error))
        ending, moved = StopReason.WATCH_FAILED, False
    if ending is StopReason.RELEASED:
        return
    with suppress(Exception):
        if ending in KILLED:
            host.kill()
    takeover.carry_out(ending.value, moved)
    if ending is not StopReason.HANDED_OVER:
        takeover.wait_for(host)


def watch(orders: int, host: Host, flag: StopFlag | None = None) -> tuple[StopReason, bool]:
    """Read heartbeats from a descriptor until there is a reason to stop watching.

    Args:
        orders: The descriptor.
        host: The host process.
        flag: Its stop flag, if it has one.

    Returns:
        The reason, and whether the first motion was complete; before it, the pose is arbitrary.
    """
    last_heartbeat, allowed, moved = time.monotonic(), MAX_SILENCE[IDLE], False
    poller = select.poll()
    for descriptor in (orders, *host.descriptors):
        poller.register(descriptor, select.POLLIN)
    longest, since = inf if flag is None else LOOK_PERIOD, time.monotonic_ns()
    while flag is None or not flag.overdue(since):
        due = last_heartbeat + allowed
        wait = min(max(due - time.monotonic(), 0.0), longest)
        ready = [descriptor for descriptor, _ in poller.poll(wait * 1e3)]
        if orders in ready:
            data = os.read(orders, 4096)
            if (ending := _ending(data, host)) is not None:
                return ending, moved
            if ticks := data.replace(IDLE, b""):
                moved = ticks.endswith(TICK)
            last_heartbeat, allowed = time.monotonic(), MAX_SILENCE[data[-1:]]
        elif ready:
            return StopReason.DIED, moved
        elif (late := time.monotonic() - due) > STALL_TIME:
            last_heartbeat, allowed = time.monotonic(), STALL_GRACE
        elif late >= 0.0:
            return StopReason.SILENT, moved
    return StopReason.IGNORED_STOP, moved


def _ending(data: bytes, host: Host) -> StopReason | None:
    """Return the reason to stop watching that the host's bytes give, or None for heartbeats."""
    if RELEASE in data:
        return StopReason.RELEASED
    if HAND_OVER in data:
        return StopReason.HANDED_OVER
    if data:
        return None
    return StopReason.DIED if host.wait(EXIT_TIME) else StopReason.CLOSED


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


def _raise_priority() -> None:
    """Set a higher priority than the loop: a loop that spins must not starve this process."""
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(PRIORITY + PRIORITY_MARGIN))
        return
    with suppress(OSError):
        os.nice(NICENESS)
