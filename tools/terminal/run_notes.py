"""What the runs of a command had to warn about: for its last line and its JSON, whatever it is.

A session leaves its warnings here when it is closed, and they are merged: the same cause in eight
runs is one warning. A command begins with none.
"""

from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from copy import deepcopy
from typing import Any

from windup.hal.backend import BusHealth
from windup.hal.errors import OutputError, UsageError
from windup.hal.guard.finding import Finding
from windup.tools.terminal.slowness import Slowness

Row = dict[str, Any]


class RunNotes:
    """The warnings of the robots that were run since `begin`.

    Attributes:
        ran: Has there been a robot at all?
        driver_clamps: Clamp of the servos' driver to the number of commands it changed.
        lost: Results that could not be written, and why; "" where nobody was there to read one.
    """

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Forget everything: a command begins."""
        self.ran = False
        self.driver_clamps: Counter[str] = Counter()
        self.lost: list[str] = []
        self._findings: dict[str, Finding] = {}
        self._slowness: Slowness | None = None
        self._rows: list[Row] = []

    def add(self, findings: Iterable[Finding], slowness: Slowness, backend: object = None) -> None:
        """Take in what a session had to warn about, and what its backend has clamped."""
        self.ran = True
        if isinstance(backend, BusHealth):
            self.driver_clamps.update(backend.clamps)
        for finding in findings:
            known = self._findings.get(finding.saying.name)
            if known is None:
                self._findings[finding.saying.name] = deepcopy(finding)
            else:
                known.merge(finding)
        if self._slowness is None:
            self._slowness = deepcopy(slowness)
        else:
            self._slowness.merge(slowness)

    def add_row(self, row: Row) -> None:
        """Take in the result of a run in another process, with `warnings` and `driver_clamps`."""
        self.ran = True
        self.driver_clamps.update(row.get("driver_clamps", {}))
        self._rows.append(row)

    @contextmanager
    def losing(self) -> Iterator[None]:
        """Note a result that cannot be written, and go on: there may be others."""
        try:
            yield
        except (OutputError, UsageError) as error:
            self.lost.append(str(error))
        except BrokenPipeError:
            self.lost.append("")

    def records(self) -> list[Row]:
        """Return all warnings for programs."""
        own = [finding.record() for finding in self._findings.values()]
        late = self._slowness.records() if self._slowness else []
        others = [
            record | {"seed": row.get("seed")} for row in self._rows for record in row["warnings"]
        ]
        return own + late + others

    def said(self, ended_by: str = "") -> str:
        """Return the warnings in one line for people, or "".

        Args:
            ended_by: Kind of what ended the run, which is said anyhow.
        """
        kinds = [finding for kind, finding in self._findings.items() if kind != ended_by]
        said = [str(finding) for finding in kinds]
        if self._slowness:
            said.append(str(self._slowness))
        unwell = [row for row in self._rows if row["warnings"]]
        if unwell:
            names = sorted({record["kind"] for row in unwell for record in row["warnings"]})
            said.append(f"{len(unwell)} of {len(self._rows)} runs had {', '.join(names)}")
        return "; ".join(said)


NOTES = RunNotes()
"""Those of this process' command."""
