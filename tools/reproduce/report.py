"""Building a report: run what is missing, draw, judge, and write one HTML file."""

import json
from io import BytesIO
from pathlib import Path
from typing import Any

from hal.errors import UsageError
from tools.output import plain
from tools.parallel import side_by_side
from tools.reproduce.figure import Figure, Result, Results, Study, distinct
from tools.reproduce.page import Entry, page
from tools.reproduce.store import Store


def reproduce(
    study: Study, figures: tuple[Figure, ...], folder: Path, *, quick: bool, jobs: int | None
) -> list[Entry]:
    """Write the report into `folder` and return what it says.

    Raises:
        UsageError: There is no matplotlib, or the folder cannot be written.
    """
    pyplot = _pyplot()
    results = collect(study, figures, Store(folder / "data", study.sources), quick, jobs)
    entries = [_entry(pyplot, figure, results, folder, quick) for figure in figures]
    try:
        text = page(study, entries, quick=quick)
        (folder / "report.html").write_text(text, encoding="utf-8")
        summary = json.dumps(plain(record(study, entries, quick=quick)), indent=2)
        (folder / "report.json").write_text(summary + "\n", encoding="utf-8")
    except OSError as error:
        raise UsageError(f"--out {folder}: {error.strerror}") from None
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
    for job, result in side_by_side(study.work, todo, label="runs", jobs=jobs):
        store.put(job, result)
        results[job] = plain(result)
    return results


def _entry(pyplot: Any, figure: Figure, results: Results, folder: Path, quick: bool) -> Entry:
    """Draw one figure from its own runs and judge it."""
    own = {job: results[job] for job in figure.jobs(quick)}
    canvas = pyplot.figure(figsize=figure.size, constrained_layout=True)
    try:
        figure.draw(canvas, own)
        buffer = BytesIO()
        canvas.savefig(buffer, format="png", dpi=100)
        (folder / f"figure-{figure.name}.png").write_bytes(buffer.getvalue())
    except OSError as error:
        raise UsageError(f"--out {folder}: {error.strerror}") from None
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


def _pyplot() -> Any:
    try:
        import matplotlib
    except ImportError:
        raise UsageError("reproduce needs matplotlib: pip install 'windup[plot]'") from None
    matplotlib.use("Agg")
    from matplotlib import pyplot

    return pyplot
