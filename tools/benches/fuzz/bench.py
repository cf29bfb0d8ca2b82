"""Thousands of odd runs, none of which may end in a traceback, hang, or exhaust the memory."""

import multiprocessing
import resource
import time as wall
from collections import Counter
from collections.abc import Iterator
from multiprocessing.connection import Connection, wait
from os import cpu_count
from typing import Any

from rich.progress import Progress

from windup.tools.benches.fuzz.trial import PATIENCE, Trial, odd_run
from windup.tools.cli import run
from windup.tools.terminal.output import console

ROBOTS = ("op3", "duck", "human", "robobird")
HANG = 3.0 * PATIENCE
"""Time after which a run that has been interrupted counts as hung, s."""
SHIFT = 100
"""Number of runs of one process, so that its peak memory can be attributed to them."""
MOST = 4 << 30
"""Address space limit of a process, bytes: the machine is shared."""
LINE = 300
"""Number of characters of a command line that are shown."""
SHOWN = 20
"""Number of faults that are shown."""


def measure_fuzz(robot: str, times: int, seed: int) -> dict[str, Any]:
    """Return the results of `times` odd runs, on `robot` and others."""
    robots = tuple(dict.fromkeys((robot, *ROBOTS)))
    seeds = iter(range(seed * times, (seed + 1) * times))
    statuses: Counter[str] = Counter()
    faults: list[Trial] = []
    interrupted = 0
    with Progress(console=console, transient=True) as progress:
        task = progress.add_task("odd runs", total=times)
        for trial in _trials(seeds, robots):
            progress.advance(task)
            statuses[str(trial.status)] += 1
            interrupted += trial.interrupted
            if trial.fault:
                faults.append(trial)
    return {
        "runs": times,
        "statuses": dict(sorted(statuses.items())),
        "interrupted": interrupted,
        "faults": len(faults),
        "kinds": dict(Counter(trial.fault for trial in faults).most_common(SHOWN)),
        "shown": [
            f"seed {trial.seed}: windup {' '.join(trial.words)[:LINE]}: {trial.fault}"
            for trial in faults[:SHOWN]
        ],
        "met": not faults,
    }


class Runner:
    """A process that executes odd runs, one after the other."""

    def __init__(self, robots: tuple[str, ...]) -> None:
        context = multiprocessing.get_context("forkserver")
        self.link, other = context.Pipe()
        self.process = context.Process(target=_serve, args=(other, robots), daemon=True)
        self.process.start()
        other.close()
        self.left = SHIFT

    def begin(self, seed: int) -> None:
        """Start the run of a seed."""
        self.seed, self.left = seed, self.left - 1
        self.deadline = wall.monotonic() + HANG
        self.link.send(seed)

    def end(self) -> Trial:
        """Return the result of its run, or that it hung or died."""
        if self.link.poll():
            try:
                trial: Trial = self.link.recv()
            except EOFError:
                self.process.join()
                self.left = 0
                return self._lost(f"the process died ({self.process.exitcode})")
            return trial
        self.process.kill()
        self.left = 0
        return self._lost("hung")

    def _lost(self, how: str) -> Trial:
        return Trial(self.seed, (), None, how, False, 0)

    def close(self) -> None:
        """End the process."""
        self.link.close()
        self.process.join(1.0)
        self.process.kill()


def _trials(seeds: Iterator[int], robots: tuple[str, ...]) -> Iterator[Trial]:
    """Yield the result of each seed's run, as they end; one process per core."""
    busy: dict[Connection, Runner] = {}
    idle = [Runner(robots) for _ in range(cpu_count() or 1)]
    try:
        while True:
            while idle and (seed := next(seeds, None)) is not None:
                runner = idle.pop()
                runner.begin(seed)
                busy[runner.link] = runner
            if not busy:
                return
            first = min(runner.deadline for runner in busy.values())
            ready = wait(list(busy), max(first - wall.monotonic(), 0.0))
            now = wall.monotonic()
            over = [link for link, runner in busy.items() if link in ready or runner.deadline < now]
            for link in over:
                runner = busy.pop(link)
                yield runner.end()
                if runner.left <= 0:
                    runner.close()
                    runner = Runner(robots)
                idle.append(runner)
    finally:
        for runner in (*busy.values(), *idle):
            runner.close()


def _serve(link: Connection, robots: tuple[str, ...]) -> None:
    """Execute the runs whose seeds are received."""
    resource.setrlimit(resource.RLIMIT_AS, (MOST, MOST))
    while True:
        try:
            seed = link.recv()
        except (EOFError, KeyboardInterrupt):
            return
        link.send(odd_run(run, seed, robots))
