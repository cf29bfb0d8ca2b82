"""Reports from tiny data; of walks only their first steps are run here."""

import json
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from windup.tools import cli
from windup.tools.command_line.version import installed_version
from windup.tools.reproduce.laszlo import LASZLO
from windup.tools.reproduce.laszlo.jobs import walk
from windup.tools.reproduce.laszlo.phase import pitch_range, scatter
from windup.tools.reproduce.laszlo.recorder import NAMES
from windup.tools.reproduce.laszlo.tours import tour
from windup.tools.reproduce.laszlo.work import VECTORS, work
from windup.tools.reproduce.study.figure import (
    Claim,
    DataTable,
    Figure,
    Job,
    Result,
    Results,
    Study,
)
from windup.tools.reproduce.study.report import collect, reproduce
from windup.tools.reproduce.study.store import Store

JOBS = [Job("square", {"x": x}) for x in (1, 2, 3)]


def square(job: Job, log: Path) -> Result:
    with log.open("a") as file:
        file.write(f"{job.options['x']}\n")
    return {"y": float(job.options["x"]) ** 2}


def draw(canvas: Any, results: Results) -> None:
    canvas.subplots().plot([result["y"] for result in results.values()])


def claims(results: Results) -> list[Claim]:
    most = max(result["y"] for result in results.values())
    return [Claim("squares < 5", f"{most:g} at most", "below 5", most < 5.0)]


def table(results: Results) -> list[DataTable]:
    return [DataTable("all", ["y"], [[f"{result['y']:g}"] for result in results.values()])]


def study(log: Path) -> Study:
    figure = Figure(
        "1.1", "Squares", "They grow.", lambda q: JOBS[:2] if q else JOBS, draw, claims, table
    )
    return Study("tiny", "Tiny", "A book.", "None.", (figure,), partial(square, log=log))


def test_a_report_is_one_page_with_its_pictures_and_computed_verdicts(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    tiny = study(tmp_path / "log")
    (entry,) = reproduce(tiny, tiny.figures, tmp_path / "out", quick=True, jobs=1)
    assert entry.claims[0].agrees
    (entry,) = reproduce(tiny, tiny.figures, tmp_path / "out", quick=False, jobs=1)
    assert not entry.claims[0].agrees
    assert "9 at most" in entry.claims[0].reason
    page = (tmp_path / "out" / "report.html").read_text()
    assert "data:image/png;base64," in page
    assert "squares &lt; 5" in page
    assert f"Windup {installed_version()}, MuJoCo " in page
    assert "http" not in page  # nothing is fetched
    assert (tmp_path / "out" / "figure-1.1.png").stat().st_size > 1000
    record = json.loads((tmp_path / "out" / "report.json").read_text())
    assert record["figures"][0]["claims"][0]["agrees"] is False
    # The quick report's runs were not run again.
    assert sorted((tmp_path / "log").read_text().split()) == ["1", "2", "3"]


def test_results_are_run_again_when_what_they_depend_on_has_changed(tmp_path: Path) -> None:
    source = tmp_path / "source.toml"
    source.write_text("a = 1")
    tiny = study(tmp_path / "log")
    store = partial(Store, tmp_path / "data", [source])
    first = collect(tiny, tiny.figures, store(), False, 1)
    assert collect(tiny, tiny.figures, store(), False, 1) == first
    assert len((tmp_path / "log").read_text().split()) == 3
    source.write_text("a = 2")
    assert store().get(JOBS[0]) is None


def test_a_spoiled_result_counts_as_none(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.put(JOBS[0], {"y": 1.0})
    next(tmp_path.glob("*.json")).write_text("{")
    assert store.get(JOBS[0]) is None


@pytest.mark.parametrize(
    "arguments", [["lazlo"], ["laszlo", "9.9"], ["laszlo", "4.3", "--out", "no/such/folder"]]
)
def test_bad_input_is_one_line_and_status_2(
    arguments: list[str], capfd: pytest.CaptureFixture[str]
) -> None:
    assert cli.run(["reproduce", *arguments]) == 2
    said = capfd.readouterr().err.strip().splitlines()
    assert len(said) == 1
    assert said[0].startswith("windup: ")


def fake_result(job: Job, steps: int = 24) -> Result:
    """Return a result of the right shape: a circle a cycle, or a straight line of responses."""
    if job.kind == "response":
        names = [f"{vector}.{axis}" for vector in VECTORS for axis in ("forward", "lateral")]
        rows = [[0.01 * k * (i + 1) for i in range(6)] for k in job.options["scalings"]]
        return {"names": names, "q": rows, "fell": [False] * len(rows)}
    record: dict[str, Any] = {
        "duration": 0.4,
        "y": 0.0,
        "speed": 1.0,
        "length": 0.4,
        "q": [0.25, 0.0],
    }
    record |= {"target": [0.25, 0.0], "k": [1.0, 2.0]}
    walked = [
        record | {"time": 0.4 * i, "x": 0.4 * i, "heading": 0.001 * i * i}
        for i in range(1, steps + 1)
    ]
    at = np.arange(0.0, 0.4 * steps, 0.02)
    trace = np.zeros((len(at), len(NAMES)))
    trace[:, 0], trace[:, 1] = at, np.floor(at / 0.4 + 1e-9)
    trace[:, NAMES.index("up.f")] = 0.1 * np.cos(2.0 * np.pi * at / 0.8)
    trace[:, NAMES.index("up.l")] = 0.1 * np.sin(2.0 * np.pi * at / 0.8)
    return {
        "requested": job.options["steps"],
        "arrived": steps >= job.options["steps"],
        "flights": steps,
        "flight_time": 0.1 * steps,
        "bend": [0.1] * len(np.arange(0.0, 0.4 * steps, 0.02)),
        "steps": steps,
        "fell": steps < job.options["steps"],
        "time": 0.4 * steps,
        "variables": ["up.forward", "up.lateral"],
        "records": walked,
        "trace": trace.tolist(),
    }


@pytest.mark.parametrize("figure", LASZLO.figures, ids=lambda figure: figure.name)
@pytest.mark.parametrize(("quick", "steps"), [(True, 24), (True, 0), (False, 60)])
@pytest.mark.filterwarnings("ignore:Mean of empty slice", "ignore:invalid value")
def test_every_figure_of_laszlo_draws_and_judges(figure: Figure, quick: bool, steps: int) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    results = {job: fake_result(job, steps) for job in figure.jobs(quick)}
    assert results
    assert {job for job in figure.jobs(True)} <= set(figure.jobs(False))
    canvas = pyplot.figure()
    figure.draw(canvas, results)
    pyplot.close(canvas)
    for claim in figure.claims(results):
        assert claim.agrees in (True, False, None)
        assert claim.ours and claim.criterion
    assert all(len(row) == len(t.header) for t in figure.table(results) for row in t.rows)


@pytest.mark.parametrize(
    "job",
    [
        Job("response", {"vary": 0, "step": 2, "scalings": [-4.0, 0.0, 4.0], "seed": 0}),
        walk(steps=2),
        tour(steps=2),
    ],
    ids=lambda job: job.kind,
)
def test_every_kind_of_run_runs(job: Job) -> None:
    result = work(job)
    if job.kind == "response":
        pitch = [row[result["names"].index("up.forward")] for row in result["q"]]
        assert pitch[0] != pitch[1] != pitch[2]
    else:
        assert (result["steps"], result["fell"], len(result["records"])) == (2, False, 2)


def test_a_circle_walked_again_and_again_is_a_limit_cycle() -> None:
    result = fake_result(Job("walk", {"steps": 60}))
    assert scatter(result) < 0.02
    assert pitch_range(result) == pytest.approx(np.degrees(2.0 * np.arcsin(0.1)), abs=0.2)
