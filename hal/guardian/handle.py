"""The guardian as its host sees it: started before torque, fed each tick, released at the end."""

import fcntl
import os
import select
import subprocess
import sys
import termios
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import IO

import msgspec
import numpy as np

from hal.backend import Backend
from hal.errors import GuardianError, HardwareError, UsageError
from hal.guard.levels import HealthLevels, Kind
from hal.guard.limits import StopPolicy
from hal.guardian.lock import AdapterLock
from hal.guardian.order import HAND_OVER, IDLE, READY, RELEASE, TICK, Charge, Order
from hal.guardian.traceback_signal import show_traceback_on_signal
from hal.joints import Array
from hal.network_port import NETWORK
from hal.open_port import stable_url
from hal.port import DevicePort
from hal.servo_backend import ServoBackend
from hal.servo_link import ServoLink

START_TIME = 20.0
"""What the process may take to start, s."""
END_TIME = 1.0
"""What it may take to end once it was released, s."""
UNREAD_TIME = 0.25
"""How long heartbeats may lie unread before the guardian counts as stopped, s."""


class Guardian:
    """The process that stops a robot when this one dies or hangs.

    Args:
        charges: The robot's buses.
        policy: What "stop" means for it.
        hold: How long "hold" lasts before torque goes off, s.

    Raises:
        PortError: Another armed run has one of the adapters.
        HardwareError: The process does not start.
    """

    def __init__(self, charges: Sequence[Charge], policy: StopPolicy, hold: float = 60.0) -> None:
        self._locks = [AdapterLock(charge.url) for charge in charges]
        numbers = [lock.take() for lock in self._locks]
        show_traceback_on_signal()
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", "from hal.guardian.process import main; main()"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            pass_fds=numbers,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
            start_new_session=True,  # signals of the terminal are for the host
        )
        assert self._process.stdin is not None and self._process.stdout is not None
        self._pipe: IO[bytes] = self._process.stdin
        self._descriptor = self._pipe.fileno()
        self._read_at = time.monotonic()
        told = [
            msgspec.structs.replace(charge, lock=number)
            for charge, number in zip(charges, numbers, strict=True)
        ]
        self._start(Order(host=os.getpid(), policy=policy, charges=tuple(told), hold=hold))

    @property
    def pid(self) -> int:
        """Its process number."""
        return self._process.pid

    @property
    def alive(self) -> bool:
        """True while it is watching."""
        return self._process.poll() is None

    def tick(self) -> None:
        """Say that the loop has done a tick; from now on the next one is due within 0.15 s.

        Raises:
            GuardianError: The guardian has died, or does not read.
        """
        self._say(TICK)

    def idle(self) -> None:
        """Say that this process is alive though no loop runs; more is due within 1 s.

        Raises:
            GuardianError: The guardian has died, or does not read.
        """
        self._say(IDLE)

    def release(self) -> None:
        """End it: torque has been read back as off."""
        self._end(RELEASE)
        try:
            self._process.wait(END_TIME)
        except subprocess.TimeoutExpired:  # stopped by somebody; there is nothing left to guard
            self._process.kill()
            self._process.wait()
        self._unlock()

    def hand_over(self) -> None:
        """Leave the robot to it: torque could not be read back as off, and the ports are closed."""
        self._end(HAND_OVER)
        self._unlock()

    def _start(self, order: Order) -> None:
        """Give the order and a first heartbeat, and wait until both have arrived."""
        with suppress(BrokenPipeError):
            self._pipe.write(msgspec.json.encode(order) + b"\n" + IDLE)
            self._pipe.flush()
        os.set_blocking(self._descriptor, False)
        answer = self._process.stdout
        assert answer is not None
        ready = select.select([answer], [], [], START_TIME)[0] and os.read(answer.fileno(), 1)
        answer.close()
        if ready != READY:
            self._process.kill()
            self._end(b"")
            self._process.wait()
            self._unlock()
            raise HardwareError(
                "the guardian that stops this robot when its program dies does not start; "
                "torque stays off"
            )

    def _say(self, byte: bytes) -> None:
        now = time.monotonic()
        if not self._unread():
            self._read_at = now
        elif now - self._read_at > UNREAD_TIME:
            raise GuardianError(f"the guardian (process {self.pid}) does not react any more")
        try:
            os.write(self._descriptor, byte)
        except BlockingIOError:
            raise GuardianError(f"the guardian (process {self.pid}) reads nothing") from None
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
) -> Guardian | None:
    """Return a running guardian of the buses of `backend`; None where no bus is outside of here.

    Args:
        backend: The backend. Buses that are emulated in this process need no guardian.
        policy: What "stop" means for the robot.
        crouch: (n,) pose of its crouch, rad.
        hold: How long "hold" lasts before torque goes off, s.
        levels: Of the robot's joints: one beyond a stop level is not held.

    Raises:
        UsageError: Servos without a bus watchdog behind a network.
        HardwareError: It does not start.
    """
    if not isinstance(backend, ServoBackend):
        return None
    links = [link for link in backend.links if _outside(link)]
    for link in links:
        _check_network(link)
    goals = None if crouch is None else backend.goal_counts(crouch)
    charges = [_charge(link, goals, levels) for link in links]
    return Guardian(charges, policy, hold) if charges else None


def _outside(link: ServoLink) -> bool:
    """Return whether another process can reach the servos of a bus."""
    port = link.bus.port
    return isinstance(port, DevicePort) or port.url.startswith(NETWORK)


def _check_network(link: ServoLink) -> None:
    """Refuse a network where its loss would leave nobody who can stop the servos.

    Raises:
        UsageError: The servos have no bus watchdog of their own.
    """
    url, registers = link.bus.port.url, link.bus.family.registers
    if url.startswith(NETWORK) and "bus_watchdog" not in registers:
        raise UsageError(
            f"{url}: these servos cannot watch their bus, so nobody could stop them when the "
            "network fails; run Windup on the machine that the adapter is plugged into"
        )


def _charge(link: ServoLink, goals: Array | None, levels: HealthLevels | None) -> Charge:
    """Return what a guardian has to know of a bus; `goals` are (n,) counts of the crouch."""
    port, line = link.bus.port, link.line
    url = port.url if "://" in port.url else stable_url(os.path.abspath(port.url))
    counts = {} if goals is None else dict(zip(line.ids, goals[line.rows].tolist(), strict=True))
    hot_and_low = {}
    if levels is not None:
        stop = levels.stop[[Kind.TEMPERATURE, Kind.SUPPLY_LOW]][:, line.rows]
        hot_and_low = {
            id: (float(hot), float(low)) for id, hot, low in zip(line.ids, *stop, strict=True)
        }
    return Charge(
        url=url,
        baud=port.baud,
        servos={mount.id: mount.model.name for mount in line.mounts},
        crouch={id: int(np.rint(count)) for id, count in counts.items()},
        levels=hot_and_low,
    )
