"""Figures 5.1 to 5.4: speed control by Eq. 5.1 with the composite regulation variable."""

from typing import Any

import numpy as np

from windup.tools.reproduce.laszlo.jobs import walk, walked
from windup.tools.reproduce.laszlo.pictures import hip_plot, numbers
from windup.tools.reproduce.laszlo.recorder import records
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Job, Result, Results

GRID = (0.1, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5)
FEW = (0.2, 0.35)
SEEDS = 2
PREMISE = "the feedback's premise: a more forward target walks faster, without it"
DESIRED = 0.4 / 0.5  # m/s: table 5.2 wants 0.4 m a step of half a second
EQUATION: dict[str, Any] = {}  # table 5.2
ONLY_LATERAL = {"gain": [0.0, 0.5]}
REVERSED = {"gain": [-1.5, 0.5]}
LAWS = (
    (EQUATION, "Eq. 5.1"),
    (ONLY_LATERAL, "its lateral part only"),
    (REVERSED, "its forward part with the other sign"),
)
SETTLED = 10


def _job(bias: float, law: dict[str, Any], seed: int = 0) -> Job:
    return walk(
        rv=["up.forward", "swing_com.lateral"],
        sampling="fl",
        forward=bias,
        lateral=-0.03,
        servo=True,
        hold=0.05,
        law=law,
        seed=seed,
    )


CHANGE = _job(0.3, {"changes": [[20, 0.4], [40, 0.3]]})


def jobs(quick: bool) -> list[Job]:
    """Return walks by Eq. 5.1, without its forward feedback, and with that reversed."""
    grid, seeds = (FEW, 1) if quick else (GRID, SEEDS)
    return [_job(q, law, seed) for law, _ in LAWS for q in grid for seed in range(seeds)]


def _speed(result: Result) -> float:
    """Return the mean speed after the start, m/s; NaN for a walk that fell."""
    return float(np.mean(records(result, "speed")[SETTLED:])) if walked(result) else float("nan")


def _rows(results: Results, law: dict[str, Any]) -> dict[float, list[Result]]:
    rows: dict[float, list[Result]] = {}
    for q in GRID:
        found = [results[j] for j in (_job(q, law, s) for s in range(SEEDS)) if j in results]
        if found:
            rows[q] = found
    return rows


def _speeds(results: Results, law: dict[str, Any]) -> dict[float, float]:
    """Return the mean speed at each bias at which every seed walks."""
    rows = _rows(results, law)
    return {
        q: float(np.mean([_speed(run) for run in runs]))
        for q, runs in rows.items()
        if all(walked(run) for run in runs)
    }


def draw(canvas: Any, results: Results) -> None:
    """Draw steps, paths, speeds over time and steady speed against the bias."""
    (steps, hips), (pace, steady) = canvas.subplots(2, 2)
    for law, label in LAWS:
        rows = _rows(results, law)
        low = [min(run["steps"] for run in runs) for runs in rows.values()]
        steps.plot(list(rows), low, marker="o", label=label)
        speeds = _speeds(results, law)
        steady.plot(list(speeds), list(speeds.values()), marker="o", label=label)
    for i, (q, runs) in enumerate(_rows(results, EQUATION).items()):
        hip_plot(hips, runs[0], f"{q:g}", f"C{i}")
        run = runs[0]
        pace.plot(records(run, "time"), records(run, "speed"), label=f"bias {q:g}", color=f"C{i}")
    steps.set(title="5.1: steps of the worst seed", xlabel="bias", ylabel="steps", ylim=(0, 64))
    steps.legend(fontsize="small")
    hips.set(title="5.1: hip plots")
    pace.set(title="5.2: speed over time", xlabel="time [s]", ylabel="m/s")
    pace.legend(fontsize="small")
    steady.set(title="5.3: steady speed (walks without falls)", xlabel="bias", ylabel="m/s")


def claims(results: Results) -> list[Claim]:
    """Judge the range, the linearity, the sign that Eq. 5.1 rests on, and the other sign."""
    speeds, free = _speeds(results, EQUATION), _speeds(results, ONLY_LATERAL)
    tried = _rows(results, EQUATION)
    return [
        Claim(
            "speed control walks over a wide range, bias 0.1 to 0.5",
            f"every seed walks at {numbers(speeds)} of {numbers(tried)}",
            "four fifths of the biases tried",
            len(speeds) >= 0.8 * len(tried),
        ),
        _linear("steady speed rises linearly with the bias", speeds, len(tried)),
        _linear(PREMISE, free, len(tried)),
        _held(_speeds(results, REVERSED)),
    ]


def _held(speeds: dict[float, float]) -> Claim:
    off = [abs(value - DESIRED) for value in speeds.values()]
    return Claim(
        f"with the other sign the feedback holds the desired {DESIRED:g} m/s",
        _text(speeds),
        "within 15 % in every walk without a fall, two biases or more",
        len(off) >= 2 and max(off) <= 0.15 * DESIRED,
        own=True,
    )


def _text(speeds: dict[float, float]) -> str:
    pairs = ", ".join(f"{q:g}: {v:.2f} m/s" for q, v in speeds.items())
    return pairs or "no bias walks with every seed"


def _linear(theirs: str, speeds: dict[float, float], tried: int) -> Claim:
    criterion = "three walks or more, on a rising line with a correlation of 0.9"
    if len(speeds) < 3:
        # A few runs cannot tell; the whole grid with fewer walks than this can.
        told = False if tried >= 3 else None
        return Claim(theirs, f"too few walks ({_text(speeds)})", criterion, told)
    from scipy.stats import linregress  # slow to import, and only the judgement needs it

    line = linregress(list(speeds), list(speeds.values()))
    return Claim(
        theirs,
        f"{_text(speeds)}: slope {line.slope:+.2f} m/s a unit, correlation {line.rvalue:+.2f}",
        criterion,
        bool(line.rvalue >= 0.9),
    )


def table(results: Results) -> list[DataTable]:
    """Return steps and speeds."""
    tables = []
    for law, label in LAWS:
        rows = []
        for q, runs in _rows(results, law).items():
            paces = [_speed(run) for run in runs if walked(run)]
            rows.append([f"{q:g}", numbers([run["steps"] for run in runs], "d"), numbers(paces)])
        tables.append(DataTable(label, ["bias", "steps by seed", "speed by seed [m/s]"], rows))
    return tables


def draw_change(canvas: Any, results: Results) -> None:
    """Draw the speed of a walk whose bias changes."""
    axis = canvas.subplots()
    run = results[CHANGE]
    axis.plot(records(run, "time"), records(run, "speed"), marker=".")
    for step in (20, 40):
        if run["steps"] > step:
            axis.axvline(run["records"][step]["time"], color="0.7", linestyle=":")
    axis.set(xlabel="time [s]", ylabel="speed [m/s]")


def claims_change(results: Results) -> list[Claim]:
    """Judge that a walk speeds up and slows down again."""
    run = results[CHANGE]
    if not walked(run):
        ours, agrees = f"falls after {run['steps']} steps", False
    else:
        v = records(run, "speed")
        slow, fast, again = (float(v[a:b].mean()) for a, b in ((12, 20), (32, 40), (52, 60)))
        ours = f"{slow:.2f}, {fast:.2f}, {again:.2f} m/s"
        agrees = fast > slow + 0.1 and fast > again + 0.1
    theirs = "a walk accelerates when the bias goes from .3 to .4 and slows down when it goes back"
    return [Claim(theirs, ours, "walks, and is 0.1 m/s faster in between", agrees)]


FIGURES = (
    Figure(
        "5.1",
        "Speed control (with 5.2 and 5.3)",
        "Up vector forward and swing-COM lateral, both corrected by the speed of the last step "
        "(Eq. 5.1, table 5.2), torso servo, hold times of .25 s: a wider range of targets, "
        "straight paths, and a steady speed linear in the bias, from nearly in place upward.",
        jobs,
        draw,
        claims,
        table,
        size=(12.0, 8.0),
    ),
    Figure(
        "5.4",
        "Acceleration and deceleration",
        "Speed follows a bias that changes in mid-walk.",
        lambda quick: [CHANGE],
        draw_change,
        claims_change,
    ),
)
