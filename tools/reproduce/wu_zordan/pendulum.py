"""Section 6, comparison to the inverted pendulum (IP): the same supervisor with d_h = 0."""

from typing import Any

import numpy as np

from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results
from windup.tools.reproduce.wu_zordan.jobs import AROUND, FOUR, cell, count, push, where

SMALL, LARGE = 170.0, 250.0  # N, of the paper
MORE = (350.0, 450.0)
RULES = ("momentum", "ip")


def _around(force: float, rule: str, quick: bool) -> list[Job]:
    around = FOUR if quick else AROUND if force <= LARGE else AROUND[::2]
    return [push(force, [direction], rule) for direction in around]


def jobs(quick: bool) -> list[Job]:
    """Return the same pushes for both rules."""
    forces = (SMALL, LARGE) if quick else (SMALL, LARGE, *MORE)
    return [job for force in forces for rule in RULES for job in _around(force, rule, quick)]


def first(run: Result) -> float:
    """Return how long after the push began the first step did, s; nan where there is none."""
    return float(run["begun"][0]) if run["begun"] else np.nan


def leads(force: float, results: Results) -> list[float]:
    """Return how much sooner the momentum supervisor steps in each direction, s."""
    ours, ip = (cell(_around(force, rule, False), results) for rule in RULES)
    gaps = [first(late) - first(soon) for soon, late in zip(ours, ip, strict=True)]
    return [gap for gap in gaps if not np.isnan(gap)]


def claims(results: Results) -> list[Claim]:
    """Judge who begins sooner, and who stays up."""
    return [_sooner(leads(LARGE, results)), *_staying_up(results), _more_robust(results)]


def _sooner(gaps: list[float]) -> Claim:
    """Judge how much sooner the momentum supervisor steps, s in each direction."""
    return Claim(
        "the momentum supervisor initiates the recovery earlier than IP",
        f"at {LARGE:g} N by {1e3 * np.mean(gaps):.0f} ms in the mean, {1e3 * min(gaps):.0f} to "
        f"{1e3 * max(gaps):.0f} ms over {len(gaps)} directions"
        if gaps
        else "none steps with both",
        "earlier in the mean, and later in no direction",
        bool(np.mean(gaps) > 0.0 and min(gaps) >= 0.0) if gaps else None,
    )


def _staying_up(results: Results) -> list[Claim]:
    """Judge who survives the paper's two forces."""
    small = [cell(_around(SMALL, rule, False), results) for rule in RULES]
    ours, ip = (cell(_around(LARGE, rule, False), results) for rule in RULES)
    fell = [run for run in ip if not run["survived"]]
    return [
        Claim(
            "under a small disturbance both keep the balance",
            f"at {SMALL:g} N {count(small[0])} directions with momentum, {count(small[1])} with IP",
            "all",
            all(run["survived"] for runs in small for run in runs),
        ),
        Claim(
            f"at {LARGE:g} N the momentum supervisor stays up",
            f"{count(ours)} directions",
            "all",
            all(run["survived"] for run in ours),
        ),
        Claim(
            f"at {LARGE:g} N IP fails (the paper does not say in which direction)",
            f"falls toward {where(fell)}, {count(ip)} stay up",
            "forward, or in half of the directions",
            any(run["directions"][0] == 0.0 for run in fell) or len(fell) >= 0.5 * len(ip),
        ),
    ]


def _more_robust(results: Results) -> Claim:
    """Judge who survives more of the pushes that are larger than the paper's."""
    total = [
        sum(run["survived"] for force in MORE for run in cell(_around(force, rule, False), results))
        for rule in RULES
    ]
    of = sum(len(cell(_around(force, "ip", False), results)) for force in MORE)
    return Claim(
        "the momentum supervisor is more robust than IP",
        f"of {of} pushes of {MORE[0]:g} and {MORE[1]:g} N momentum survives {total[0]}, "
        f"IP {total[1]}",
        "more",
        total[0] > total[1] if of else None,
    )


def draw(canvas: Any, results: Results) -> None:
    """Draw when the first step begins in each direction, crosses for falls."""
    axes = canvas.subplots(1, 2, sharey=True)
    for axis, force in zip(axes, (SMALL, LARGE), strict=True):
        for rule, colour in zip(RULES, ("tab:blue", "tab:red"), strict=True):
            for run in cell(_around(force, rule, False), results):
                mark = "o" if run["survived"] else "x"
                axis.plot(run["directions"][0], 1e3 * first(run), mark, color=colour)
        axis.set(xlabel="push toward [deg]", title=f"{force:g} N for 0.1 s")
    axes[0].set_ylabel("first step after [ms]")
    axes[0].plot([], [], "o", color="tab:blue", label="momentum")
    axes[0].plot([], [], "o", color="tab:red", label="IP (x: fell)")
    axes[0].legend()


def table(results: Results) -> list[DataTable]:
    """Return how many directions each rule survives."""
    rows = []
    for force in (SMALL, LARGE, *MORE):
        runs = [cell(_around(force, rule, False), results) for rule in RULES]
        if runs[0]:
            rows.append([f"{force:g}", *map(count, runs)])
    return [DataTable("directions survived", ["force [N]", "momentum", "IP"], rows)]


FIGURES = (
    Figure(
        "IP",
        "Comparison to the inverted pendulum",
        "Without angular momentum (d_h = 0) the recovery begins later. Both survive small "
        "disturbances; at 250 N for 0.1 s the momentum supervisor stays up and IP falls.",
        jobs,
        draw,
        claims,
        table,
    ),
)
