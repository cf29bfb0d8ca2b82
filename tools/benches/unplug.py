"""A robot's adapter is pulled out and put in again, over and over, at random moments.

The servos are those of `windup emulate`, in real time and on pseudo-terminals: what is opened,
lost and opened again are true descriptors.
"""

import gc
import multiprocessing
import os
import resource
import tempfile
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from windup.hal.command import JointCommand
from windup.hal.errors import HardwareError, PortError, WindupError
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.robots import load_robot
from windup.tools.benches.safety.emulated import serve
from windup.tools.robot.stack import servo_backend
from windup.tools.terminal.output import console

FIRST = 3.0  # s; the robot is armed by then
OUT = (0.1, 0.6)  # s that the adapter is out
BETWEEN = (0.8, 2.8)  # s from it being back to the next time; some come before it is armed again
PERIOD = 0.008  # s
PATIENCE = 20.0  # s for anything to happen
WARM = 10  # times after which memory is compared


@dataclass
class Times:
    """How often what happened.

    Attributes:
        lost: The port was missed.
        found: It was opened again.
        off: All torque was off then, read back from the servos.
        withheld: A goal was not sent then.
        armed: Arming again switched all torque on.
        descriptors: Open descriptors, each time that it was found again.
        memory: Peak of the memory, kB, the same.
    """

    lost: int = 0
    found: int = 0
    off: int = 0
    withheld: int = 0
    armed: int = 0
    descriptors: list[int] = field(default_factory=list)
    memory: list[int] = field(default_factory=list)


def measure_unplugs(name: str, times: int = 100, seed: int = 0) -> dict[str, Any]:
    """Return how often the port was found again, with torque off until armed, and what leaked.

    Args:
        name: The robot.
        times: How often the adapter is pulled out.
        seed: Seed of the moments.

    Raises:
        WindupError: The robot was not there for a long time.
    """
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    with tempfile.TemporaryDirectory() as folder:
        faults = script(times, seed, load_robot(name).buses[0].name)
        arguments = (name, Path(folder) / "bus", theirs, faults)
        emulator = context.Process(target=serve, args=arguments, daemon=True)
        emulator.start()
        try:
            backend = servo_backend(load_robot(name), ours.recv())
            backend.connect()
            try:
                backend.configure()
                backend.set_torque(True)
                return _row(watch(backend, times), times)
            finally:
                backend.disconnect()
        finally:
            emulator.kill()
            emulator.join()


def script(times: int, seed: int, bus: str) -> str:
    """Return the faults that pull out the adapter of `bus` so often."""
    rng, moment, rules = np.random.default_rng(seed), FIRST, []
    for _ in range(times):
        out = rng.uniform(*OUT)
        rules.append(f"unplug:at={moment:.4f}:seconds={out:.4f}:bus={bus}")
        moment += out + rng.uniform(*BETWEEN)
    return ",".join(rules)


def watch(backend: ServoBackend, times: int) -> Times:
    """Go on as a loop would until the port was pulled out so often, arming whenever it is back.

    Raises:
        WindupError: It is gone, or not pulled out, for too long.
    """
    seen, link, gone = Times(), backend.links[0], False
    hold = JointCommand.hold(backend.joints, backend.read().joints.position)
    since = due = backend.clock.now()
    with console.status("") as status:
        while seen.lost < times or gone or link.barred:
            due = max(due + PERIOD, backend.clock.now())
            backend.clock.wait_until(due)
            backend.read()
            if (link.lost is not None) is not gone:
                gone, since = not gone, due
                seen.lost += gone
                status.update(f"pulled out {seen.lost} times of {times}")
                if not gone:
                    _examine(backend, hold, seen)
            elif link.barred and not gone:
                with suppress(PortError, HardwareError):  # it may be pulled out meanwhile
                    seen.armed += bool(backend.rearm().all_on)
                    since = due
            backend.write(hold)
            if due - since > PATIENCE:
                raise WindupError(f"nothing happened for {PATIENCE:g} s after {seen.lost} times")
    return seen


def _examine(backend: ServoBackend, hold: JointCommand, seen: Times) -> None:
    """Note what the robot is like that was found again, before it is armed."""
    seen.found += 1
    withheld = backend.clamps["unarmed"]
    backend.write(hold)
    seen.withheld += backend.clamps["unarmed"] > withheld
    with suppress(PortError):
        seen.off += backend.links[0].torque.state().all_off
    gc.collect()
    seen.descriptors.append(len(os.listdir("/dev/fd")))
    seen.memory.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


def _row(seen: Times, times: int) -> dict[str, Any]:
    warm = min(WARM, seen.found - 1)
    return {
        "pulled_out": times,
        "missed": seen.lost,
        "found_again": seen.found,
        "torque_off_then": seen.off,
        "goals_withheld_then": seen.withheld,
        "armed_again": seen.armed,
        "descriptors_first_last": [seen.descriptors[0], seen.descriptors[-1]],
        "memory_grown_kb": seen.memory[-1] - seen.memory[warm],
    }
