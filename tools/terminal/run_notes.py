"""Collects the warnings of a command's runs, for its last line and its JSON.

A session adds its warnings when it is closed, and they are merged: the same cause in eight runs is
one warning. Each command begins without warnings.
"""

from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from copy import deepcopy
from typing import TYPE_CHECKING, Any

from windup.hal.errors import OutputError, UsageError
from windup.tools.terminal.slowness import Slowness

if TYPE_CHECKING:  # `windup stop` does without NumPy
    from windup.hal.guard.finding import Finding

Row = dict[str, Any]


class RunNotes:
    """The warnings of the robots that were run since `begin`.

    Attributes:
        ran: Whether any robot was run.
        driver_clamps: Number of commands changed by each clamp of the servo driver.
        lost: Reasons why results could not be written; "" for a reader that closed its pipe.
    """

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Clear everything, at the beginning of a command."""
        self.ran = False
        self.driver_clamps: Counter[str] = Counter()
        self.lost: list[str] = []
        self._findings: dict[str, Finding] = {}
        self._slowness: Slowness | None = None
        self._rows: list[Row] = []

    def add(
        self, findings: Iterable["Finding"], slowness: Slowness, backend: object = None
    ) -> None:
        """Add the warnings of a session, and the clamp counts of its backend."""
        from windup.hal.backend import BusHealth

        self.ran = True
        if isinstance(backend, BusHealth):
            self.driver_clamps.update(backend.clamps)
        for finding in findings:
            known = self._findings.get(finding.text.name)
            if known is None:
                self._findings[finding.text.name] = deepcopy(finding)
            else:
                known.merge(finding)
        if self._slowness is None:
            self._slowness = deepcopy(slowness)
        else:
            self._slowness.merge(slowness)

    def add_row(self, row: Row) -> None:
        """Add the result of a run in another process, with `warnings` and `driver_clamps`."""
        self.ran = True
        self.driver_clamps.update(row.get("driver_clamps", {}))
        self._rows.append(row)

    @contextmanager
    def collecting_output_errors(self) -> Iterator[None]:
        """Record a failure to write a result, and continue: there may be other results."""
        try:
            yield
        except (OutputError, UsageError) as error:
            self.lost.append(str(error))
        except BrokenPipeError:
            self.lost.append("")

    def records(self) -> list[Row]:
        """Return all warnings as plain data."""
        own = [finding.record() for finding in self._findings.values()]
        late = self._slowness.records() if self._slowness else []
        others = [
            record | {"seed": row.get("seed")} for row in self._rows for record in row["warnings"]
        ]
        return own + late + others

    def summary(self, ended_by: str = "") -> str:
        """Return the warnings in one line, or "".

        Args:
            ended_by: Kind of the finding that ended the run, which is reported separately.
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
"""The warnings of the command of this process."""
