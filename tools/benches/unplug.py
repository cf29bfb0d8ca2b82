"""Pulls out a robot's adapter and plugs it in again, many times, at random moments.

The servos are those of `windup emulate`, in real time and on pseudo-terminals, so that real
descriptors are opened, lost and opened again.
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

FIRST = 3.0  # time of the first unplugging, when the robot is armed, s
OUT_TIMES = (0.1, 0.6)  # range of times for which the adapter is out, s
PLUGGED_TIMES = (0.8, 2.8)  # range of times from its return to the next unplugging, s
PERIOD = 0.008  # s
PATIENCE = 20.0  # longest time in which nothing happens, s
WARM = 10  # number of unpluggings before the reference for memory


@dataclass
class UnplugCounts:
    """Counts of events.

    Attributes:
        lost: Times that the loss of the port was noticed.
        found: Times that it was opened again.
        off: Times that all torque was off then, read back from the servos.
        withheld: Times that a goal was withheld then.
        armed: Times that arming again switched all torque on.
        descriptors: Open descriptors, each time that the port was opened again.
        memory: Peak memory at the same times, kB.
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
        times: Number of unpluggings.
        seed: Seed of the moments.

    Raises:
        WindupError: The robot was unreachable for too long.
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
    """Return the faults that unplug the adapter of `bus` `times` times."""
    rng, moment, rules = np.random.default_rng(seed), FIRST, []
    for _ in range(times):
        out = rng.uniform(*OUT_TIMES)
        rules.append(f"unplug:at={moment:.4f}:seconds={out:.4f}:bus={bus}")
        moment += out + rng.uniform(*PLUGGED_TIMES)
    return ",".join(rules)


def watch(backend: ServoBackend, times: int) -> UnplugCounts:
    """Run a loop until the port was lost `times` times, and arm whenever it is back.

    Raises:
        WindupError: It is lost, or not unplugged, for too long.
    """
    seen, link, gone = UnplugCounts(), backend.links[0], False
    hold = JointCommand.hold(backend.joints, backend.read().joints.position)
    since = due = backend.clock.now()
    with console.status("") as status:
        while seen.lost < times or gone or link.goals_withheld:
            due = max(due + PERIOD, backend.clock.now())
            backend.clock.wait_until(due)
            backend.read()
            if (link.lost is not None) is not gone:
                gone, since = not gone, due
                seen.lost += gone
                status.update(f"pulled out {seen.lost} times of {times}")
                if not gone:
                    _examine(backend, hold, seen)
            elif link.goals_withheld and not gone:
                with suppress(PortError, HardwareError):  # it may be unplugged meanwhile
                    seen.armed += bool(backend.rearm().all_on)
                    since = due
            backend.write(hold)
            if due - since > PATIENCE:
                raise WindupError(f"nothing happened for {PATIENCE:g} s after {seen.lost} times")
    return seen


def _examine(backend: ServoBackend, hold: JointCommand, seen: UnplugCounts) -> None:
    """Record the state of the robot when it is reachable again, before it is armed."""
    seen.found += 1
    withheld = backend.clamps["unarmed"]
    backend.write(hold)
    seen.withheld += backend.clamps["unarmed"] > withheld
    with suppress(PortError):
        seen.off += backend.links[0].torque.state().all_off
    gc.collect()
    seen.descriptors.append(len(os.listdir("/dev/fd")))
    seen.memory.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


def _row(seen: UnplugCounts, times: int) -> dict[str, Any]:
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
