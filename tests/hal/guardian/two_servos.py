"""Two STS3215 on a pseudo-terminal, emulated in a process of their own, and their host."""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TypeVar

from windup.hal.bus.bus import Bus
from windup.hal.errors import HardwareError
from windup.hal.families import FEETECH_STS
from windup.hal.guardian.order import GuardedBus
from windup.hal.port.open_port import open_port
from windup.hal.registers import Register

NAMES = {1: "l_knee", 2: "r_knee"}
IDS = {1: "STS3215-7.4V", 2: "STS3215-7.4V"}
TORQUE = FEETECH_STS.registers["torque_enable"]
GOAL = FEETECH_STS.registers["goal_position"]
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
EMULATE = [sys.executable, "-c", "from windup.tools.cli import main; main()", "emulate"]
T = TypeVar("T")


@contextmanager
def emulated(*arguments: str) -> "Iterator[subprocess.Popen[str]]":
    with subprocess.Popen([*EMULATE, *arguments], stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if line.startswith("Ctrl-C"):
                break
        try:
            yield process
        finally:
            process.kill()


def record(path: Path) -> GuardedBus:
    return GuardedBus(url=str(path), baud=1_000_000, servos=IDS)


def patiently(ask: Callable[[], T]) -> T:
    """Ask again where a busy machine has kept a servo from its answer."""
    for _ in range(20):
        with suppress(HardwareError):
            return ask()
    return ask()


def show(path: Path, register: Register) -> list[int]:
    with open_port(str(path), 1_000_000, exclusive=False) as port:
        bus = Bus(port, FEETECH_STS)
        return [patiently(partial(bus.read, id, register)) for id in IDS]


def switch_on(path: Path) -> None:
    with open_port(str(path), 1_000_000, exclusive=False) as port:
        bus = Bus(port, FEETECH_STS)
        for id in IDS:
            patiently(partial(bus.write, id, TORQUE, 1))


@contextmanager
def full_pipe() -> Iterator[int]:
    """Yield the writing end of a pipe that is full, and that nobody reads."""
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    for size in (4096, 1):
        with suppress(BlockingIOError):
            while True:
                os.write(writing, b"x" * size)
    os.set_blocking(writing, True)
    try:
        yield writing
    finally:
        os.close(reading)
        os.close(writing)


def wait_for_end(number: int) -> None:
    while runs(number):
        time.sleep(0.01)


def runs(number: int) -> bool:
    """Does the process still run?"""
    try:
        return Path(f"/proc/{number}/stat").read_text().split(") ")[1][0] != "Z"
    except FileNotFoundError:
        return False


HOST = """
import sys, time
from windup.hal.guardian.handle import Guardian
from windup.hal.guardian.order import GuardedBus
from tests.hal.guardian.two_servos import IDS, switch_on
path, policy, hold = sys.argv[1:]
crouch = {1: 1800, 2: 2300}
record = GuardedBus(url=path, baud=1_000_000, servos=IDS, crouch=crouch)
guardian = Guardian([record], policy, float(hold))
switch_on(path)
guardian.tick()
print(guardian.pid, flush=True)
while True:
    guardian.tick()
    time.sleep(0.005)
"""


@contextmanager
def host(
    path: Path, policy: str, hold: float = 60.0, errors: int | None = subprocess.PIPE
) -> "Iterator[tuple[subprocess.Popen[str], int]]":
    """Start a program with two servos on; yield its process and the number of its guardian.

    Its standard error goes to `errors`; it is closed with None.
    """
    start = [sys.executable, "-c", HOST, str(path), policy, str(hold)]
    with subprocess.Popen(
        ["sh", "-c", 'exec "$@" 2>&-', "sh", *start] if errors is None else start,
        stdout=subprocess.PIPE,
        stderr=errors,
        env=ENVIRONMENT,
        text=True,
    ) as process:
        assert process.stdout is not None
        try:
            yield process, int(process.stdout.readline())
        finally:
            process.kill()
