"""`windup bench`: what ticks, physics, rollouts and servos cost, as ratios of one run."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import inf
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from hal.errors import UsageError
from tools.bench_balance import measure_balance
from tools.bench_jitter import measure_jitter
from tools.bench_loop import measure_tick, measure_twin
from tools.bench_servo import measure_servos
from tools.bench_stop import ENDS, measure_stops
from tools.bench_wire import Maker, measure_bus
from tools.output import console, write_json
from tools.stop_rig import End

What = Literal["tick", "twin", "balance", "servo", "bus", "stop", "loop"]


@dataclass(frozen=True)
class Bench:
    """Measure what the stack costs."""

    what: Annotated[What, tyro.conf.Positional]
    """tick: one turn of the loop. twin: stepping through the guard against bare physics.
    balance: the rollouts of one step. servo: the twin's servo against its data sheet.
    bus: a cycle of 20 servos against the wire and other packages.
    stop: how soon the torque is off when the controller ends, crashes or dies (10 minutes).
    loop: how late our loop wakes at 125 Hz, beside a C program that only sleeps."""
    robot: str = "op3"
    """Name of the robot, or path of its folder."""
    vendor: Maker = "dynamixel2"
    """bus: whose servos: STS3215, MX-28 under protocol 1, or XM430 under protocol 2."""
    moments: int = 20
    """stop: random moments of each way to end."""
    end: End | Literal["all"] = "all"
    """stop: by what the run ends."""
    seed: int = 0
    """stop: seed of the moments."""
    minutes: float = 10.0
    """loop: how long."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def run(self) -> int:
        """Measure; returns the exit status."""
        if self.moments < 1:
            raise UsageError(f"--moments {self.moments}: give 1 or more")
        if not 0.0 < self.minutes < inf:
            raise UsageError(f"--minutes {self.minutes:g}: give more than 0")
        measures: dict[str, Callable[[str], dict[str, Any]]] = {
            "tick": measure_tick,
            "twin": measure_twin,
            "balance": measure_balance,
            "servo": measure_servos,
            "bus": partial(measure_bus, maker=self.vendor),
            "loop": partial(measure_jitter, minutes=self.minutes),
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
        return 0
