"""Millions of readings of all servo families under each kind of fault, checked with the truth."""

import time
from collections.abc import Iterator
from itertools import product
from typing import Any, NamedTuple

from windup.hal.errors import UsageError
from windup.tools.benches.soak import Soak, Tally
from windup.tools.benches.soak_rig import FAMILIES, SoakRig
from windup.tools.benches.soak_verdict import KINDS, LATE_ADAPTER, MIX, MIXED, verdict
from windup.tools.terminal.parallel import run_parallel

RATES = (0.01, 0.05)
"""Shares of the answers that are hit; the mix uses the first only, as few survive the second."""
CHUNK = 25_000
"""Number of readings of one emulated bus."""
BREAKDOWNS = 0.01
"""Share of the cycles with breakdowns, in the mix of all faults."""
LATE = 16e-3
"""Latency of an FTDI adapter in its factory setting, s."""


class FaultCase(NamedTuple):
    """A combination of servos and a fault."""

    family: str
    kind: str
    rate: float


class WorkItem(NamedTuple):
    """One work item of a process."""

    cell: FaultCase
    reads: int
    seed: int


def measure_faults(reads: int = 10_000_000, seed: int = 0) -> dict[str, Any]:
    """Return the results of `reads` servo readings, divided among all families, faults and rates.

    Args:
        reads: Total number of readings, on benches of 20 servos of one family.
        seed: Seed of the faults.

    Raises:
        UsageError: `reads` is below 1.
    """
    if reads < 1:
        raise UsageError(f"--reads {reads}: give 1 or more")
    began = time.monotonic()
    cells = [
        FaultCase(*each) for each in product(FAMILIES, KINDS, RATES) if each[1:] != (MIX, RATES[1])
    ]
    tallies = {cell: Tally() for cell in cells}
    positions: dict[str, float] = {}
    items = [*_items(cells, -(-reads // len(cells)), seed)]
    for item, (tally, position) in run_parallel(_soak, items, label="faults"):
        tallies[item.cell].add(tally)
        positions[item.cell.family] = position
    rows = [verdict(*cell, tallies[cell], positions[cell.family]) for cell in cells]
    return {
        "cells": rows,
        "reads": sum(row["reads"] for row in rows),
        "minutes": round((time.monotonic() - began) / 60.0, 1),
        "met": all(row["met"] for row in rows),
    }


def _items(cells: list[FaultCase], reads: int, seed: int) -> Iterator[WorkItem]:
    """Yield the work items: `reads` readings per cell, in pieces."""
    pieces = max(1, round(reads / CHUNK))
    for piece, cell in product(range(pieces), cells):
        yield WorkItem(cell, -(-reads // pieces), seed + piece)


def _soak(item: WorkItem) -> tuple[Tally, float]:
    """Return the tally of the readings, and the share of the position bytes in an answer."""
    (family, kind, rate), reads, seed = item
    latency = LATE if kind == LATE_ADAPTER else 0.0
    with SoakRig(family, seed=seed, latency=latency) as rig:
        soak = Soak(rig, _faults(kind, rate), seed, BREAKDOWNS if kind == MIX else 0.0)
        return soak.run(reads), rig.position_share


def _faults(kind: str, rate: float) -> dict[str, float]:
    """Return the rates of the faults on the bus; a late adapter also loses answers."""
    if kind == MIX:
        return dict.fromkeys(MIXED, rate)
    return {"drop" if kind == LATE_ADAPTER else kind: rate}
