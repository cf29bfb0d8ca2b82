"""A process of its own that stops the servos when their host dies, where they have no watchdog.

It sleeps until the host's end of a pipe closes or the host is gone, then opens the buses anew and
switches the torque off, or has the servos stay where they are, until that has been read back. It
holds no port before: an adapter may come and go, and nobody finds it busy.
"""

import json
import logging
import os
import select
import subprocess
import sys
import time
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from typing import IO

from hal.backend import Backend
from hal.bus import Bus
from hal.errors import HardwareError
from hal.families import family_of
from hal.guard import StopPolicy
from hal.open_port import open_port, stable_url
from hal.port import DevicePort
from hal.servo_backend import ServoBackend
from hal.servo_line import ServoLine
from hal.servo_link import ServoLink
from hal.servo_model import ServoMount
from hal.servo_torque import ServoTorque
from hal.servos import servo_model

READY, RELEASE = b"r", b"x"
START_TIME = 20.0
"""What the process may take to start, s."""
PERSISTENCE = 30.0
"""How long it goes on trying to reach servos that do not obey, s."""
PAUSES = 5e-3, 0.25
"""Between two attempts, s: the first, and the longest."""


@dataclass(frozen=True)
class Charge:
    """A bus that is looked after.

    Attributes:
        url: Of its port.
        baud: Bits a second.
        servos: Id to model name.
    """

    url: str
    baud: int
    servos: Mapping[int, str]


class Guardian:
    """The process, as its host sees it.

    Args:
        charges: The buses.
        policy: What to do when the host dies. "hold" holds; the others are limp at once: there is
            nobody left to see to a crouch.

    Raises:
        HardwareError: The process does not start.
    """

    def __init__(self, charges: Iterable[Charge], policy: StopPolicy) -> None:
        order = {"policy": policy, "charges": [asdict(charge) for charge in charges]}
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", "from hal.guardian import main; main()"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
            start_new_session=True,  # Ctrl-C is for the host
        )
        assert self._process.stdin is not None and self._process.stdout is not None
        self._stdin: IO[bytes] = self._process.stdin
        with suppress(BrokenPipeError):
            self._stdin.write(json.dumps({"host": os.getpid(), **order}).encode() + b"\n")
            self._stdin.flush()
        answer = self._process.stdout
        ready = select.select([answer], [], [], START_TIME)[0] and os.read(answer.fileno(), 1)
        answer.close()
        if ready != READY:
            self._process.kill()
            self.release()
            raise HardwareError(
                "the guardian that stops these servos when this program dies does not start; "
                "torque stays off"
            )

    @property
    def alive(self) -> bool:
        """Is it watching?"""
        return self._process.poll() is None

    def release(self) -> None:
        """End it; the servos stay as they are."""
        with suppress(BrokenPipeError, ValueError):
            self._stdin.write(RELEASE)
            self._stdin.flush()
        with suppress(BrokenPipeError):
            self._stdin.close()
        self._process.wait()


def guardian_for(backend: Backend, policy: StopPolicy) -> Guardian | None:
    """Return a guardian of the buses of `backend` that need one, or None if none does.

    Raises:
        HardwareError: It does not start.
    """
    links = backend.links if isinstance(backend, ServoBackend) else []
    charges = [_charge(link) for link in links if _needs_one(link)]
    return Guardian(charges, policy) if charges else None


def _needs_one(link: ServoLink) -> bool:
    """Can the servos not watch over their host, and can another process reach them?"""
    watches = "bus_watchdog" in link.bus.family.registers
    return not watches and isinstance(link.bus.port, DevicePort)


def _charge(link: ServoLink) -> Charge:
    port = link.bus.port
    servos = {mount.id: mount.model.name for mount in link.line.mounts}
    return Charge(stable_url(os.path.abspath(port.url)), port.baud, servos)


def carry_out(charges: Iterable[Charge], policy: StopPolicy, patience: float = PERSISTENCE) -> bool:
    """Carry out the policy on all buses; return whether all servos have been read back.

    Args:
        charges: The buses.
        policy: As of `Guardian`.
        patience: How long to go on trying, s.
    """
    until, pause = time.monotonic() + patience, PAUSES[0]
    left = {charge.url: charge for charge in charges}
    lines: dict[str, ServoTorque] = {}
    while left:
        for url, charge in list(left.items()):
            try:
                if url not in lines:
                    lines[url] = _open(charge)
                if _obeys(lines[url], policy):
                    del left[url]
            except HardwareError:
                if (failed := lines.pop(url, None)) is not None:
                    failed.line.bus.port.close()
        if time.monotonic() > until:
            break
        if left:
            time.sleep(pause)
            pause = min(2.0 * pause, PAUSES[1])
    for torque in lines.values():
        torque.line.bus.port.close()
    return not left


def _open(charge: Charge) -> ServoTorque:
    """Open a bus; also one that a child of the dead host still has open."""
    port = open_port(charge.url, charge.baud, exclusive=False)
    mounts = _mounts(charge)
    bus = Bus(port, family_of(mounts[0].model.name))
    return ServoTorque(ServoLine(bus, mounts, list(range(len(mounts)))), 0.0)


def _mounts(charge: Charge) -> list[ServoMount]:
    named = [(id, servo_model(name)) for id, name in charge.servos.items()]
    return [ServoMount(model, "", id, 1, model.middle, 1.0) for id, model in named]


def _obeys(torque: ServoTorque, policy: StopPolicy) -> bool:
    """Carry out the policy on one bus, once; return whether that has been read back."""
    if policy == "hold":
        torque.stay()
        return True
    return torque.off(attempts=1).all_off


def main() -> None:
    """Be the guardian: orders come on standard input, with the host's number."""
    with open(sys.stdin.fileno(), "rb", buffering=0, closefd=False) as orders:
        order = json.loads(orders.readline())
    charges = [
        Charge(each["url"], each["baud"], {int(id): name for id, name in each["servos"].items()})
        for each in order["charges"]
    ]
    for charge in charges:  # what cannot be has to come out now, not when it matters
        _mounts(charge)
    host = _host(order["host"])
    os.write(sys.stdout.fileno(), READY)
    if _released(host):
        return
    done = carry_out(charges, order["policy"])
    what = "they hold" if order["policy"] == "hold" else "their torque is off"
    said = f"{what}, read back" if done else "they do NOT OBEY; cut the servo power"
    urls = ", ".join(charge.url for charge in charges)
    logging.getLogger(__name__).warning("the program with the servos on %s died: %s", urls, said)


def _host(number: int) -> list[int]:
    """Return a descriptor that is readable once the host is gone, where the system has such."""
    try:
        return [os.pidfd_open(number)]
    except (OSError, AttributeError):  # it has gone already, or an old kernel: the pipe tells too
        return []


def _released(host: list[int]) -> bool:
    """Sleep until the host lets the guardian go (True) or dies (False)."""
    orders = sys.stdin.fileno()
    ready, _, _ = select.select([orders, *host], [], [])
    return orders in ready and os.read(orders, 1) == RELEASE
