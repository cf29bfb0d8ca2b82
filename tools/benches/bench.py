"""`windup bench`: the cost of ticks, physics, rollouts and servos, as ratios within one run."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from windup.hal.errors import UsageError
from windup.hal.ranges import Range
from windup.tools.benches.balance import measure_balance
from windup.tools.benches.faults import measure_faults
from windup.tools.benches.fuzz.bench import measure_fuzz
from windup.tools.benches.guardian import measure_takeovers
from windup.tools.benches.jitter import measure_jitter
from windup.tools.benches.leaks import measure_leaks
from windup.tools.benches.random_starts import measure_starts
from windup.tools.benches.safety.bench import ROBOTS, measure_safety
from windup.tools.benches.servo import measure_servos
from windup.tools.benches.slow.bench import measure_slow
from windup.tools.benches.soak_table import fault_table
from windup.tools.benches.startup import measure_startup
from windup.tools.benches.tick import measure_tick
from windup.tools.benches.twin import measure_twin
from windup.tools.benches.unplug import measure_unplugs
from windup.tools.benches.wire import BenchFamily, measure_bus
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.quantities import Count, Seed

BenchName = Literal[
    "tick",
    "twin",
    "balance",
    "servo",
    "bus",
    "safety",
    "guardian",
    "loop",
    "slow",
    "faults",
    "unplug",
    "leaks",
    "starts",
    "fuzz",
    "startup",
]

USED: dict[BenchName, tuple[str, ...]] = {
    "tick": ("robot",),
    "twin": ("robot",),
    "balance": ("robot",),
    "servo": ("robot",),
    "bus": ("vendor",),
    "safety": ("robot", "moments", "rows", "seed"),
    "guardian": ("robot", "minutes"),
    "loop": ("robot", "minutes"),
    "slow": ("robot", "minutes"),
    "faults": ("reads", "seed"),
    "unplug": ("robot", "times", "seed"),
    "leaks": ("robot", "times"),
    "starts": ("robot", "times", "seed"),
    "fuzz": ("robot", "times", "seed"),
    "startup": ("times",),
}
"""The options that each bench accepts, besides --json."""


@dataclass(frozen=True)
class Bench(Command):
    """Measure the cost and the safety of the stack."""

    what: Annotated[BenchName, tyro.conf.Positional]
    """What to measure.
    tick: one iteration of the loop, in ms and in bare physics steps of OP3; without --robot also
    of the human, and status 1 if one takes longer than its target.
    twin: guarded stepping of the twin against bare physics.
    balance: the rollouts of one step. servo: the twin's servo against its data sheet.
    bus: a cycle of 20 servos against the bus's own time and other packages.
    safety: end a moving robot in every way there is, and check that torque goes off (an hour).
    guardian: takeovers during a walk beside a busy process, where none is due (give --minutes 30).
    loop: wake-up lateness of our loop at 125 Hz, beside a C program that only sleeps.
    slow: late ticks and plans of walks that have 35 % of one core, where none is due (as root).
    faults: readings that are wrong or lost under each kind of bus fault (3 minutes).
    unplug: a robot whose adapter is pulled out and plugged in again (4 minutes).
    starts: starts of a robot from random poses, without and with a fault in it (5 min).
    fuzz: odd command lines on broken robots; none may end in a traceback (give --times 10000).
    startup: time of each way to start, as a ratio to importing NumPy (a minute).
    leaks: resources left over by opening and closing a robot 1000 times (10 minutes); status 1 if
    that is more than 5 MB, or any file, thread or process."""
    robot: str | None = None
    """Name of the robot, or path of its folder; op3 by default, safety and slow: op3 and duck."""
    vendor: BenchFamily = "dynamixel2"
    """bus: the servos and their protocol: STS3215, MX-28 (protocol 1), or XM430 (protocol 2)."""
    moments: Count = 20
    """safety: number of random moments for each way to end, shared by the robots."""
    rows: tuple[str, ...] = ()
    """safety: only the rows whose names begin with one of these; all by default."""
    reads: Annotated[int, Range(1, 10**9)] = 10_000_000
    """faults: total number of servo readings."""
    times: Count | None = None
    """unplug, leaks, starts, fuzz and startup: repetitions; 100, 1000, 100, 1000, and 20."""
    seed: Seed = 0
    """safety, faults, unplug, fuzz: seed of the random numbers; starts: of the first start."""
    minutes: Annotated[float, Range(0.0, 10_000.0, "minutes", above=True)] | None = None
    """loop, guardian, slow: duration of all walks, or of each; 10, 10, and 1."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def check(self) -> None:
        """Check the options.

        Raises:
            UsageError: A number is out of its range, or an option belongs to another bench.
        """
        super().check()
        for option in fields(self):
            known = option.name in ("what", "json", *USED[self.what])
            if not known and getattr(self, option.name) != option.default:
                takers = ", ".join(what for what, names in USED.items() if option.name in names)
                raise UsageError(f"bench {self.what} takes no --{option.name}; these do: {takers}")

    def run(self) -> int:
        """Measure and print the result; return the exit status."""
        measures: dict[str, Callable[..., dict[str, Any]]] = {
            "tick": partial(measure_tick, targets=self.robot is None),
            "twin": measure_twin,
            "balance": measure_balance,
            "servo": measure_servos,
            "bus": partial(measure_bus, maker=self.vendor),
            "loop": partial(measure_jitter, minutes=self.minutes or 10.0),
            "guardian": partial(measure_takeovers, minutes=self.minutes or 10.0),
            "unplug": partial(measure_unplugs, times=self.times or 100, seed=self.seed),
            "leaks": partial(measure_leaks, times=self.times or 1_000),
            "starts": partial(measure_starts, starts=self.times or 100, seed=self.seed),
            "fuzz": partial(measure_fuzz, times=self.times or 1_000, seed=self.seed),
            "startup": partial(measure_startup, times=self.times or 20),
        }
        if self.what == "safety":
            return self._safety()
        if self.what == "slow":
            return self._slow()
        if self.what == "faults":
            return self._faults()
        robot = {"robot": self.robot or "op3"} if "robot" in USED[self.what] else {}
        result = measures[self.what](*robot.values())
        for key, value in result.items():
            console.print(f"{key:28} {value}")
        write_json(self.json, f"bench {self.what}", {**robot, **result})
        return 0 if result.get("met", True) else 1

    def _faults(self) -> int:
        """Measure readings under faults, and print them in a table of their own."""
        result = measure_faults(self.reads, self.seed)
        console.print(fault_table(result["cells"]))
        console.print(
            f"wrong readings that were called fresh, of {result['reads']}; "
            f"{result['minutes']} minutes; {'met' if result['met'] else 'NOT MET'}"
        )
        write_json(self.json, "bench faults", result)
        return 0 if result["met"] else 1

    def _safety(self) -> int:
        """Measure safety, and print it in a table of its own."""
        robots = ROBOTS if self.robot is None else (self.robot,)
        result = measure_safety(self.moments, self.seed, self.rows, robots)
        console.print(
            f"{result['safe']} of {result['planned']} endings are safe, "
            f"{result['planned'] - result['trials']} not measured, {result['refused']} of "
            f"{len(result['refusals'])} refusals are right; {result['minutes']} minutes",
            soft_wrap=True,
        )
        write_json(self.json, "bench safety", result)
        return 0 if result["met"] else 1

    def _slow(self) -> int:
        """Measure walks on a slow computer; each prints its line."""
        result = measure_slow(self.robot, self.minutes or 1.0)
        write_json(self.json, "bench slow", result)
        return 0 if result["met"] else 1
