"""`windup bench`: what ticks, physics, rollouts and servos cost, as ratios of one run."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from hal.ranges import Range
from tools.bench_balance import measure_balance
from tools.bench_faults import measure_faults
from tools.bench_jitter import measure_jitter
from tools.bench_leaks import measure_leaks
from tools.bench_loop import measure_tick, measure_twin
from tools.bench_servo import measure_servos
from tools.bench_stop import ENDS, measure_stops
from tools.bench_unplug import measure_unplugs
from tools.bench_wire import Maker, measure_bus
from tools.command import Command
from tools.output import console, write_json
from tools.quantities import Count, Seed
from tools.stop_rig import End

What = Literal[
    "tick", "twin", "balance", "servo", "bus", "stop", "loop", "faults", "unplug", "leaks"
]


@dataclass(frozen=True)
class Bench(Command):
    """Measure what the stack costs."""

    what: Annotated[What, tyro.conf.Positional]
    """tick: one turn of the loop. twin: stepping through the guard against bare physics.
    balance: the rollouts of one step. servo: the twin's servo against its data sheet.
    bus: a cycle of 20 servos against the wire and other packages.
    stop: how soon the torque is off when the controller ends, crashes or dies (10 minutes).
    loop: how late our loop wakes at 125 Hz, beside a C program that only sleeps.
    faults: what becomes of the readings of each family while everything goes wrong (3 minutes).
    unplug: what becomes of a robot whose adapter is pulled out and put in again (4 minutes).
    leaks: what opening and closing a robot leaves behind; 1000 times (10 minutes), status 1 if that
    is more than 5 MB, or any file, thread or process."""
    robot: str = "op3"
    """Name of the robot, or path of its folder."""
    vendor: Maker = "dynamixel2"
    """bus: whose servos: STS3215, MX-28 under protocol 1, or XM430 under protocol 2."""
    moments: Count = 20
    """stop: random moments of each way to end."""
    end: End | Literal["all"] = "all"
    """stop: by what the run ends."""
    reads: Annotated[int, Range(1, 10**9)] = 1_000_000
    """faults: how often servos of each family are read."""
    times: Count | None = None
    """unplug and leaks: how often; 100, and 1000."""
    seed: Seed = 0
    """stop, faults, unplug: seed of the moments."""
    minutes: Annotated[float, Range(0.0, 10_000.0, "minutes", above=True)] = 10.0
    """loop: how long."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def run(self) -> int:
        """Measure; returns the exit status."""
        measures: dict[str, Callable[[str], dict[str, Any]]] = {
            "tick": measure_tick,
            "twin": measure_twin,
            "balance": measure_balance,
            "servo": measure_servos,
            "bus": partial(measure_bus, maker=self.vendor),
            "loop": partial(measure_jitter, minutes=self.minutes),
            "unplug": partial(measure_unplugs, times=self.times or 100, seed=self.seed),
            "leaks": partial(measure_leaks, times=self.times or 1_000),
            "faults": partial(measure_faults, reads=self.reads, seed=self.seed),
            "stop": partial(
                measure_stops,
                moments=self.moments,
                seed=self.seed,
                ends=ENDS if self.end == "all" else (self.end,),
            ),
        }
        result = measures[self.what](self.robot)
        for key, value in result.items():
            console.print(f"{key:28} {value}")
        write_json(self.json, f"bench {self.what}", {"robot": self.robot, **result})
        return 0 if result.get("good", True) else 1
