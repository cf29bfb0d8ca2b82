"""Kenwright's statements judged on made-up results, and the shortest real run of each kind."""

from typing import Any

import numpy as np
import pytest

from windup.tools.reproduce.kenwright import KENWRIGHT, falls, pushes, regions, turning, walking
from windup.tools.reproduce.kenwright.comfort import before
from windup.tools.reproduce.kenwright.jobs import fall, push, stride
from windup.tools.reproduce.kenwright.recorder import NAMES, column
from windup.tools.reproduce.kenwright.steps import paths
from windup.tools.reproduce.kenwright.work import work
from windup.tools.reproduce.study.figure import Figure, Job, Result


def fake_result(job: Job, good: bool = True) -> Result:
    """Return a run: a step of the left foot, and (where it is good) the way back."""
    time = np.arange(0.0, 4.0, 0.02)
    trace = np.zeros((len(time), len(NAMES)))
    trace[:, 0] = time
    swing = (time >= 1.0) & (time < 1.2)
    trace[swing, NAMES.index("phase")] = 1.0
    trace[swing, NAMES.index("left.z")] = 0.02 * np.sin(np.pi * (time[swing] - 1.0) / 0.2)
    trace[:, NAMES.index("left.y")] = 0.12
    away = 0.08 * ((time >= 1.2) & ((time < 3.0) | (not good)))
    trace[:, NAMES.index("left.x")] = away
    trace[:, NAMES.index("left.yaw")] = 0.0 if good else 0.5
    options: dict[str, Any] = dict(job.options)
    if job.kind == "stride":
        return fake_stride(options, good)
    falls = [{"foot": "left_foot", "x": 0.1, "y": 0.1, "forbidden": not good}]
    kept = {"landings": falls, "landed_forbidden": int(not good)} if "forbid" in options else {}
    return kept | {
        "directions": options["directions"],
        "impulse": options["impulse"],
        "seed": 0,
        "survived": good,
        "steps": 1,
        "comfort_steps": int(good),
        "astray_m": 0.005 if good else 0.08,
        "tick_ms": {"p50": 0.4, "p99": 0.8},
        "trace": trace.tolist(),
        "begun": [{"time": 1.0, "foot": 0, "share": 0.7}],
        "torso_impact_m_s": 0.5 if options.get("protect") else 1.0,
        "head_impact_m_s": 0.0,
        "peak_load": 1.0,
        "reach": 0.1 if good else None,
        "powered": good,
    }


def fake_stride(options: dict[str, Any], good: bool) -> Result:
    """Return a walk that went where it was ordered to, or fell."""
    heading = options.get("heading", 0.0)
    leg = {"begin": 0.0, "speed": 0.1, "heading": heading}
    leg |= {"measured_speed": 0.102, "measured_heading": heading + (0.0 if good else 40.0)}
    second = {**leg, "heading": 60.0, "measured_heading": 62.0}
    return {
        "good": good,
        "reason": "done" if good else "fell",
        "steps": 20,
        "turned_deg": 58.0 if good else 0.0,
        "legs": [leg, second] if "then" in options else [leg],
        "path": [[0.0, 0.0, 0.0, 0.0], [1.0, 0.1, 0.0, 0.0]],
    }


@pytest.mark.parametrize("figure", KENWRIGHT.figures, ids=lambda figure: figure.name)
@pytest.mark.parametrize(("quick", "good"), [(True, True), (True, False), (False, True)])
@pytest.mark.filterwarnings("ignore:Mean of empty slice", "ignore:invalid value")
def test_every_statement_is_drawn_and_judged(figure: Figure, quick: bool, good: bool) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    results = {job: fake_result(job, good) for job in figure.jobs(quick)}
    assert set(figure.jobs(True)) <= set(figure.jobs(False))
    canvas = pyplot.figure()
    figure.draw(canvas, results)
    pyplot.close(canvas)
    claims = figure.claims(results)
    assert claims
    assert all(claim.agrees in (True, False, None) for claim in claims)
    assert all(claim.ours and claim.criterion for claim in claims)
    assert all(len(row) == len(t.header) for t in figure.table(results) for row in t.rows)


def test_verdicts_follow_the_data() -> None:
    good = {job: fake_result(job) for job in pushes.jobs(True)}
    bad = {job: fake_result(job, good=False) for job in pushes.jobs(True)}
    assert [claim.agrees for claim in pushes.claims(good)] == [True, True, True]
    assert [claim.agrees for claim in pushes.claims(bad)] == [False, True, False]


def test_verdicts_on_walks_and_holes_follow_the_data() -> None:
    for module, jobs in ((walking.claims, walking.jobs), (regions.claims_hole, regions.hole_jobs)):
        good, bad = ({job: fake_result(job, well) for job in jobs(True)} for well in (True, False))
        assert all(claim.agrees for claim in module(good))
        assert not module(bad)[0].agrees
    step = {job: fake_result(job) for job in turning.jobs(True)}
    assert [claim.agrees for claim in turning.claims(step)] == [True, True, True]


def test_a_way_back_and_a_swing_are_found_in_the_trace() -> None:
    result = fake_result(push(1.8, [0.0]))
    assert before(result) == pytest.approx(0.08)
    ((part, height),) = paths(result)
    assert part[int(np.argmax(height))] == pytest.approx(0.5, abs=0.1)


def test_a_push_is_traced_and_a_fall_is_measured() -> None:
    pushed = work(push(0.3, [90.0]))
    assert pushed["survived"]
    assert pushed["begun"] == []
    moved = column(pushed, "com.y")
    assert np.ptp(moved) > 0.001
    fallen = work(fall(90.0, protect=True))
    assert not fallen["survived"]
    assert falls.trunk(fallen) > 0.0
    assert fallen["reach"] is not None
    assert fallen["powered"]


def test_a_walk_is_traced() -> None:
    walked = work(stride(seconds=1.0, then=["0.5,0.05,90"]))
    assert walked["good"]
    assert len(walked["legs"]) == 2
    assert len(walked["path"]) > 20
