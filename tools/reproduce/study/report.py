"""Building a report: run what is missing, draw, judge, and write one HTML file."""

import json
from io import BytesIO
from pathlib import Path
from typing import Any

from windup.tools.reproduce.study.figure import Figure, Result, Results, Study, distinct
from windup.tools.reproduce.study.page import Entry, page
from windup.tools.reproduce.study.store import Store
from windup.tools.terminal.output import to_json_types
from windup.tools.terminal.parallel import run_parallel
from windup.tools.terminal.picture import load_pyplot
from windup.tools.terminal.writing import writing


def reproduce(
    study: Study, figures: tuple[Figure, ...], folder: Path, *, quick: bool, jobs: int | None
) -> list[Entry]:
    """Write the report into `folder` and return what it says.

    Raises:
        UsageError: There is no matplotlib, or the folder cannot be made.
        OutputError: The report cannot be written.
    """
    pyplot = load_pyplot("reproduce")
    results = collect(study, figures, Store(folder / "data", study.sources), quick, jobs)
    entries = [_entry(pyplot, figure, results, folder, quick) for figure in figures]
    text = page(study, entries, quick=quick)
    summary = json.dumps(to_json_types(record(study, entries, quick=quick)), indent=2)
    with writing(folder):
        (folder / "report.html").write_text(text, encoding="utf-8")
        (folder / "report.json").write_text(summary + "\n", encoding="utf-8")
    return entries


def collect(
    study: Study, figures: tuple[Figure, ...], store: Store, quick: bool, jobs: int | None = None
) -> Results:
    """Return the results of all jobs of `figures`, running those that the store has not."""
    wanted = list(distinct(figures, quick))
    results: dict[Any, Result] = {}
    for job in wanted:
        if (kept := store.get(job)) is not None:
            results[job] = kept
    todo = [job for job in wanted if job not in results]
    for job, result in run_parallel(study.work, todo, label="runs", jobs=jobs):
        store.put(job, result)
        results[job] = to_json_types(result)
    return results


def _entry(pyplot: Any, figure: Figure, results: Results, folder: Path, quick: bool) -> Entry:
    """Draw one figure from its own runs and judge it."""
    own = {job: results[job] for job in figure.jobs(quick)}
    canvas = pyplot.figure(figsize=figure.size, constrained_layout=True)
    try:
        figure.draw(canvas, own)
        buffer = BytesIO()
        canvas.savefig(buffer, format="png", dpi=100)
        with writing(folder):
            (folder / f"figure-{figure.name}.png").write_bytes(buffer.getvalue())
    finally:
        pyplot.close(canvas)
    return Entry(figure, buffer.getvalue(), figure.claims(own), figure.table(own), len(own))


def record(study: Study, entries: list[Entry], *, quick: bool) -> dict[str, Any]:
    """Return what programs read of a report."""
    return {
        "study": study.name,
        "quick": quick,
        "figures": [
            {
                "name": entry.figure.name,
                "title": entry.figure.title,
                "runs": entry.runs,
                "claims": [
                    {
                        "theirs": claim.theirs,
                        "ours": claim.ours,
                        "criterion": claim.criterion,
                        "agrees": claim.agrees,
                        "own": claim.own,
                    }
                    for claim in entry.claims
                ],
            }
            for entry in entries
        ],
        "not_yet": study.missing,
    }
