"""`windup bench safety`: measures the whole table of endings, for OP3 and the duck."""

import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from os import cpu_count
from typing import Any

import numpy as np
from rich.table import Table

from windup.hal.errors import UsageError
from windup.robots import load_robot
from windup.tools.benches.safety.attempt import trial, under_way
from windup.tools.benches.safety.endings import own_fault
from windup.tools.benches.safety.moment import Moment
from windup.tools.benches.safety.refusals import measure_refusals
from windup.tools.benches.safety.row import Ending
from windup.tools.benches.safety.rows import ROWS, SIGNALS
from windup.tools.benches.safety.scripts import BY_ITSELF
from windup.tools.benches.safety.trial import NotMeasuredError
from windup.tools.benches.safety.verdict import Verdict, judge
from windup.tools.terminal.output import console

ROBOTS = ("op3", "duck")
LONGEST = {"standing": 1.0, "walking": 1.5, "closing crouch": 1.2}
"""Longest time from the beginning of each activity to the ending, s."""
WIDE = 150
"""Width of the table, characters."""
SPARE = 1
"""Number of simultaneous trials beyond one per core: each of them waits for half of its time."""
AGAIN = 3
"""Number of attempts at a trial whose program was not under way when it should be ended."""


def measure_safety(
    moments: int = 20, seed: int = 0, only: Sequence[str] = (), robots: Sequence[str] = ROBOTS
) -> dict[str, Any]:
    """Return the results of each way to end a run.

    Args:
        moments: Number of trials per row, shared by the robots.
        seed: Seed of the moments.
        only: Names of rows, or the beginnings of names; all if empty.
        robots: The robots.

    A trial that could not be measured counts as one that is not safe.

    Raises:
        UsageError: There is no such row.
    """
    rows = [row for row in ROWS if not only or any(row.name.startswith(name) for name in only)]
    if not rows:
        raise UsageError(f"no row begins with {', '.join(only)}; see docs/safety.md")
    began = time.monotonic()
    rng = np.random.default_rng(seed)
    result = {row.name: _measure(row, moments, rng, robots) for row in rows}
    refused = {} if only else measure_refusals(robots)
    safe = sum(row["safe"] for row in result.values())
    planned = sum(row["planned"] for row in result.values())
    trials = sum(row["trials"] for row in result.values())
    console.print(_table(result), width=WIDE)
    right = sum(each["right"] for each in refused.values())
    return {
        "met": safe == trials == planned > 0 and right == len(refused),
        "safe": safe,
        "planned": planned,
        "trials": trials,
        "refused": right,
        "refusals": refused,
        "minutes": round((time.monotonic() - began) / 60.0, 1),
        "rows": result,
    }


def _measure(
    row: Ending, moments: int, rng: np.random.Generator, robots: Sequence[str]
) -> dict[str, Any]:
    """Return the results of one row."""
    failed: Counter[str] = Counter()
    todo = list(_moments(row, moments, rng, robots))
    with ThreadPoolExecutor((cpu_count() or 1) + SPARE) as pool:
        tried = pool.map(lambda item: _try(item[0], row, item[1], failed), todo)
        both = zip(todo, tried, strict=True)
        seen = [(name, verdict) for (name, _), verdict in both if verdict is not None]
    times = [verdict.seconds for _, verdict in seen]
    wrong = [{"robot": name, **asdict(verdict)} for name, verdict in seen if verdict.wrong]
    report = {
        "planned": len(todo),
        "trials": len(seen),
        "safe": len(seen) - len(wrong),
        "longest_s": round(max(times), 3) if times else None,
        "allowed_s": row.within,
        "crouch": row.crouch,
        "t0": row.start,
        "while": dict(Counter(verdict.activity for _, verdict in seen)),
        "status": dict(Counter(str(verdict.status) for _, verdict in seen)),
        "found": dict(Counter(verdict.found for _, verdict in seen)),
        "wrong": wrong,
        "not_measured": dict(failed),
    }
    console.print(f"{row.name}: {report['safe']} of {len(todo)} safe, {report['longest_s']} s")
    if len(seen) < len(todo):
        console.print(f"  NOT MEASURED: {len(todo) - len(seen)} of {len(todo)}")
    for reason, count in failed.items():
        console.print(f"  attempts in vain, {count} x {reason}", markup=False, soft_wrap=True)
    for each in wrong:
        said = f"  {each['robot']} {each['activity']}: {each['wrong']}\n{each['words']}"
        console.print(said, markup=False, soft_wrap=True)
    return report


def _moments(
    row: Ending, count: int, rng: np.random.Generator, robots: Sequence[str]
) -> Iterator[tuple[str, Moment]]:
    """Yield the robots in turn, with random moments of the row's activities."""
    mine = [name for name in robots if not row.robots or name in row.robots]
    if not mine:
        return
    for k in range(count):
        activity = row.activities[k // len(mine) % len(row.activities)]
        yield mine[k % len(mine)], Moment(activity, float(rng.uniform(0.0, LONGEST[activity])))


def _try(name: str, row: Ending, moment: Moment, failed: Counter[str]) -> Verdict | None:
    """Return the verdict on one trial, or None if its program never got under way."""
    for _ in range(AGAIN):
        try:
            return _one(name, row, moment)
        except NotMeasuredError as error:
            failed[f"{name}: {error}"] += 1
    return None


def _one(name: str, row: Ending, moment: Moment) -> Verdict:
    with trial(name, row, moment) as running:
        under_way(running)
        if row.carry_out is not own_fault:
            running.journal.listen(moment.after)
            if BY_ITSELF in (said := running.errors()):
                raise NotMeasuredError(said)
        verdict = judge(running, row, load_robot(name), row.carry_out(running))
        if verdict.wrong and row in SIGNALS and BY_ITSELF in (said := running.errors()):
            raise NotMeasuredError(said)  # the robot fell at that very moment
        return verdict


def _table(result: dict[str, Any]) -> Table:
    """Return the results as a table."""
    table = Table("fault", "t0", "state", "safe", "s", "of", "status", "read", box=None)
    table.columns[0].no_wrap = True
    for name, row in result.items():
        table.add_row(
            name,
            row["t0"],
            ", ".join(f"{count} {what}" for what, count in row["while"].items()),
            f"{row['safe']}/{row['planned']}",
            str(row["longest_s"]),
            f"{row['allowed_s']:g}" + " + crouch" * row["crouch"],
            ", ".join(row["status"]),
            ", ".join(row["found"]),
        )
    return table
