"""Results of jobs as JSON files, so that a report broken off goes on where it was."""

import hashlib
import json
from collections.abc import Iterable
from os import replace
from pathlib import Path
from typing import Any

from windup.hal.errors import UsageError
from windup.tools.reproduce.study.figure import Job, Result
from windup.tools.terminal.output import to_json_types
from windup.tools.terminal.writing import writing

SUFFIXES = (".py", ".toml", ".xml")


class Store:
    """A folder with one file a job.

    Args:
        folder: The folder; made if it is not there.
        sources: Files and folders that results depend on.

    Raises:
        UsageError: The folder cannot be made.
    """

    def __init__(self, folder: Path, sources: Iterable[Path] = ()) -> None:
        self.folder = folder
        self.fingerprint = fingerprint(sources)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UsageError(f"--out {folder.parent}: {error.strerror}") from None

    def get(self, job: Job) -> Result | None:
        """Return the result of a job, or None where there is none."""
        try:
            kept: dict[str, Any] = json.loads(self._path(job).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        result: Result = kept["result"]
        return result

    def put(self, job: Job, result: Result) -> None:
        """Keep the result of a job."""
        path = self._path(job)
        text = json.dumps({"job": self._identity(job), "result": to_json_types(result)})
        with writing(path):
            path.with_suffix(".new").write_text(text, encoding="utf-8")
            replace(path.with_suffix(".new"), path)

    def _identity(self, job: Job) -> dict[str, Any]:
        return {"kind": job.kind, "options": dict(job.options), "sources": self.fingerprint}

    def _path(self, job: Job) -> Path:
        text = json.dumps(self._identity(job), sort_keys=True)
        return self.folder / f"{job.kind}-{hashlib.sha256(text.encode()).hexdigest()[:20]}.json"


def fingerprint(sources: Iterable[Path]) -> str:
    """Return a hash of the program and data files in `sources`."""
    digest = hashlib.sha256()
    for source in sources:
        inside = sorted(source.rglob("*")) if source.is_dir() else [source]
        for path in inside:
            if path.suffix in SUFFIXES:
                digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()[:16]
