"""Host side of the guardian: starts it before torque enable, sends heartbeats, releases it."""

import fcntl
import os
import select
import subprocess
import sys
import termios
import time
from collections.abc import Sequence
from contextlib import ExitStack, suppress
from typing import IO

import msgspec

from windup.hal.backend import Backend
from windup.hal.error_text import error_text
from windup.hal.errors import GuardianError, HardwareError
from windup.hal.guard.levels import HealthLevels
from windup.hal.guard.limits import StopPolicy
from windup.hal.guardian.guarded_buses import guarded_buses
from windup.hal.guardian.launch import launch
from windup.hal.guardian.order import (
    FIRST,
    HAND_OVER,
    IDLE,
    READY,
    RELEASE,
    TICK,
    GuardedBus,
    GuardianOrder,
)
from windup.hal.guardian.signals import signals_blocked
from windup.hal.guardian.traceback_signal import show_traceback_on_signal
from windup.hal.joints import Array
from windup.hal.port.lock import AdapterLock
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.hal.stopping.stop_flag import StopFlag

NOT_STARTED = (
    "the guardian process, which stops this robot if its program dies, does not start{}; "
    "torque stays off"
)
START_TIME = 20.0
"""Maximum time for the process to start, s."""
END_TIME = 1.0
"""Maximum time for the process to end after its release, s."""
UNREAD_TIME = 0.25
"""Maximum time for which heartbeats may stay unread before the guardian counts as hung, s."""


class Guardian:
    """Handle of the guardian process, which stops the robot if this process dies or hangs.

    Args:
        buses: The robot's buses.
        policy: Stop policy to carry out.
        hold: Duration of the policy "hold" before torque goes off, s.
        flag: Stop flag of this program: a request that it does not see within 0.1 s makes the
            guardian stop the robot.

    Raises:
        PortError: Another armed run holds the lock of an adapter.
        HardwareError: The process does not start.
    """

    def __init__(
        self,
        buses: Sequence[GuardedBus],
        policy: StopPolicy,
        hold: float = 60.0,
        flag: StopFlag | None = None,
    ) -> None:
        self._locks: list[AdapterLock] = []
        self._flag = flag
        try:
            with ExitStack() as undo:  # also on Ctrl-C, which the program may catch
                locked = tuple(self._lock(record, undo) for record in buses)
                show_traceback_on_signal()
                with signals_blocked():
                    self._process = launch([record.lock for record in locked])
                    undo.callback(self._kill)
                assert self._process.stdin is not None
                self._pipe: IO[bytes] = self._process.stdin
                self._descriptor = self._pipe.fileno()
                self._read_at = time.monotonic()
                self._start(
                    GuardianOrder(
                        host=os.getpid(), policy=policy, buses=locked, hold=hold,
                        flag="" if flag is None else str(flag.path),
                    )
                )  # fmt: skip
                if flag is not None:
                    flag.guardian = self.pid
                undo.pop_all()
        except OSError as error:
            raise HardwareError(NOT_STARTED.format(f" ({error_text(error)})")) from error

    @property
    def pid(self) -> int:
        """Process id of the guardian."""
        return self._process.pid

    @property
    def alive(self) -> bool:
        """True while the guardian process runs."""
        return self._process.poll() is None

    def tick(self, first: bool = False) -> None:
        """Send the heartbeat of a tick of the loop; the next one is due within 0.15 s.

        Args:
            first: The first motion after torque enable is not complete: on a stop the robot goes
                limp instead of crouching.

        Raises:
            GuardianError: The guardian has died, or does not read its heartbeats.
        """
        self._send(FIRST if first else TICK)

    def idle(self) -> None:
        """Send a heartbeat while no loop runs; the next one is due within 1 s.

        Raises:
            GuardianError: The guardian has died, or does not read its heartbeats.
        """
        self._send(IDLE)

    def release(self) -> None:
        """End the guardian after torque has been read back as off."""
        self._end(RELEASE)
        try:
            self._process.wait(END_TIME)
        except subprocess.TimeoutExpired:  # suspended; it is no longer needed
            self._process.kill()
            self._process.wait()
        finally:
            self._unlock()
            if self._flag is not None:
                self._flag.guardian = 0

    def hand_over(self) -> None:
        """Let the guardian stop the robot: torque did not read back as off; ports are closed."""
        self._end(HAND_OVER)
        self._unlock()

    def _lock(self, record: GuardedBus, undo: ExitStack) -> GuardedBus:
        """Lock the adapter of a bus; return the record of the bus with the lock's descriptor.

        Raises:
            PortError: Another armed run holds the lock.
        """
        lock = AdapterLock(record.url)
        undo.callback(lock.close)
        self._locks.append(lock)
        return msgspec.structs.replace(record, lock=lock.acquire())

    def _start(self, order: GuardianOrder) -> None:
        """Send the order and a first heartbeat, and wait until the guardian confirms both."""
        with suppress(BrokenPipeError):
            self._pipe.write(msgspec.json.encode(order) + b"\n" + IDLE)
            self._pipe.flush()
        os.set_blocking(self._descriptor, False)
        answer = self._process.stdout
        assert answer is not None
        poller = select.poll()
        poller.register(answer, select.POLLIN)
        ready = poller.poll(START_TIME * 1e3) and os.read(answer.fileno(), 1)
        answer.close()
        if ready != READY:
            raise HardwareError(NOT_STARTED.format(""))

    def _kill(self) -> None:
        """Kill a guardian that has not begun to watch; torque is still off."""
        with signals_blocked():
            self._process.kill()
            self._process.wait()
            for pipe in filter(None, (self._process.stdin, self._process.stdout)):
                with suppress(OSError):
                    pipe.close()

    def _send(self, byte: bytes) -> None:
        now = time.monotonic()
        if not self._unread():
            self._read_at = now
        elif now - self._read_at > UNREAD_TIME:
            raise GuardianError(f"the guardian (process {self.pid}) no longer reads its heartbeats")
        try:
            os.write(self._descriptor, byte)
        except BlockingIOError:
            raise GuardianError(
                f"the guardian (process {self.pid}) does not read its heartbeats"
            ) from None
        except (OSError, ValueError):
            raise GuardianError(f"the guardian (process {self.pid}) has died") from None

    def _unread(self) -> int:
        """Return how many heartbeats the guardian has not read yet."""
        try:
            count = fcntl.ioctl(self._descriptor, termios.FIONREAD, b"\0\0\0\0")
        except (OSError, ValueError):
            return 0
        return int.from_bytes(count, sys.byteorder)

    def _end(self, byte: bytes) -> None:
        with suppress(OSError, ValueError):
            self._pipe.write(byte)
            self._pipe.flush()
        with suppress(OSError):
            self._pipe.close()

    def _unlock(self) -> None:
        for lock in self._locks:
            lock.close()


def guardian_for(
    backend: Backend,
    policy: StopPolicy,
    crouch: Array | None = None,
    hold: float = 60.0,
    levels: HealthLevels | None = None,
    flag: StopFlag | None = None,
) -> Guardian | None:
    """Start and return a guardian of the buses of `backend`, or None if all of them are emulated.

    Args:
        backend: The backend. Buses that are emulated in this process need no guardian.
        policy: Stop policy of the robot.
        crouch: (n,) pose of its crouch, rad.
        hold: Duration of the policy "hold" before torque goes off, s.
        levels: Health levels of the joints: beyond a stop level, a pose is not held.
        flag: Stop flag of this program.

    Raises:
        UsageError: Servos without a bus watchdog are reached through a network.
        HardwareError: The guardian does not start.
    """
    if not isinstance(backend, ServoBackend):
        return None
    buses = guarded_buses(backend, crouch, levels)
    return Guardian(buses, policy, hold, flag) if buses else None
