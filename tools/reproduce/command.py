"""The command line of `windup reproduce`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from windup.hal.errors import UnknownNameError
from windup.tools.reproduce.studies import studies
from windup.tools.reproduce.study.report import record, reproduce
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.quantities import Jobs
from windup.tools.terminal.writing import check_folder


@dataclass(frozen=True, kw_only=True)
class Reproduce(Command):
    """Reproduce the figures of a paper: a report with its statements beside ours.

    Runs that were done before are not done again, so that after Ctrl-C the same line goes on.
    """

    paper: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="PAPER")]
    """Which paper: laszlo, kenwright or wu-zordan."""
    figures: Annotated[tuple[str, ...], tyro.conf.Positional, tyro.conf.arg(metavar="FIGURE")] = ()
    """Figures, such as 4.3; all by default."""
    quick: bool = False
    """A few runs for each figure, in a minute or two, instead of all."""
    out: Path | None = None
    """Folder for report.html, the pictures and the runs; reproduce-PAPER by default."""
    jobs: Jobs | None = None
    """Processes; one a core by default."""
    json: Path | None = None
    """Write the verdicts as JSON to a file, or to standard output with '-'."""

    def run(self) -> int:
        """Reproduce; returns the exit status. A claim that differs is a result, not a failure."""
        known = studies()
        if self.paper not in known:
            raise UnknownNameError("paper", self.paper, known)
        study = known[self.paper]
        figures = study.choose(self.figures)
        folder = self.out or Path(f"reproduce-{study.name}")
        check_folder(folder)
        entries = reproduce(study, figures, folder, quick=self.quick, jobs=self.jobs)
        for entry in entries:
            console.print(
                f"{entry.figure.name:>5}  {entry.count:<22}  {entry.figure.title}",
                markup=False,
                soft_wrap=True,
            )
        console.print(f"report: {folder / 'report.html'}", markup=False)
        write_json(self.json, "reproduce", record(study, entries, quick=self.quick))
        return 0
