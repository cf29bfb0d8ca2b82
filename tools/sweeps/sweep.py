"""`windup sweep`: runs a command over a grid of its options, or at random values of them."""

import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Annotated

import tyro

from windup.hal.errors import UsageError
from windup.tools.sweeps.sweep_grid import Axis, parse_axis, points
from windup.tools.sweeps.sweep_run import Run, check_line, play
from windup.tools.sweeps.sweep_table import Row, Table, open_table
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console
from windup.tools.terminal.parallel import run_parallel
from windup.tools.terminal.quantities import Count, Jobs, Seed, Seeds
from windup.tools.terminal.writing import check_writable, writing

MOST = 1_000_000
"""Largest number of runs in a sweep."""


@dataclass(frozen=True, kw_only=True)
class Sweep(Command):
    """Run a command at many values of its options; one row for each run.

    Rows that the file already contains are not run again: after Ctrl-C, or with a larger grid, the
    same command line continues the sweep.

    windup sweep walk human --rv up --grid target=.1:.4:7 --grid sampling=sp,fl,lf --seeds 8 --out
    walks.csv
    """

    line: Annotated[tuple[str, ...], tyro.conf.Positional, tyro.conf.arg(metavar="COMMAND ARGS")]
    """The command and its options: all words that are not options of the sweep."""
    grid: tyro.conf.UseAppendAction[tuple[str, ...]] = ()
    """An option and its values: name=v1,v2,.. or name=low:high:count; join several values of one
    option with '+'. May be given several times."""
    random: Count | None = None
    """Draw this many random points from the grid's ranges and lists, instead of all of them."""
    seed: Seed = 0
    """Seed of the random points."""
    seeds: Seeds = 1
    """Run seeds 0 .. N-1 at each point."""
    out: Path
    """File for the rows, .csv or .parquet."""
    jobs: Jobs | None = None
    """Number of processes; one per core by default."""

    def check(self) -> None:
        """Check the options; see `Command.check`."""
        super().check()
        axes = self._axes()
        count = self.seeds * (self.random or prod(len(axis.values) for axis in axes))
        if count > MOST:
            raise UsageError(f"a grid of {count} runs: give values and --seeds for up to {MOST}")
        points(axes, self.random, self.seed)
        check_line(list(self.line), axes)
        check_writable(self.out)

    def _axes(self) -> list[Axis]:
        return [parse_axis(text) for text in self.grid]

    def run(self) -> int:
        """Run the sweep; return 1 if a run ended in an error, else 0."""
        places = points(self._axes(), self.random, self.seed)
        table = open_table(self.out)
        command = shlex.join(self.line)
        runs = [Run(command, place, seed) for place in places for seed in range(self.seeds)]
        todo = list(_missing(runs, table.rows))
        console.print(f"{len(runs)} runs, {len(runs) - len(todo)} of them in {self.out} already")
        errors = self._collect(table, todo)
        console.print(f"rows: {self.out}", markup=False)
        if errors:
            console.print(
                f"{len(errors)} runs ended in an error, the first: {errors[0]}", markup=False
            )
        return 1 if errors else 0

    def _collect(self, table: Table, todo: list[Run]) -> list[str]:
        """Run the missing runs, add each row to the table, and return the errors."""
        errors = []
        try:
            for _, row in run_parallel(play, todo, label="runs", jobs=self.jobs):
                with writing(self.out):
                    table.append(row)
                if row["error"] is not None:
                    errors.append(row["error"])
        finally:
            if todo:
                with writing(self.out):
                    table.close()
        return errors


def _missing(runs: list[Run], rows: list[Row]) -> Iterator[Run]:
    """Yield the runs without a row, each once."""
    names = list(runs[0].key)
    seen = {tuple(row.get(name) for name in names) for row in rows}
    for run in runs:
        key = tuple(run.key.values())
        if key not in seen:
            seen.add(key)
            yield run
