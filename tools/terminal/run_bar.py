"""The progress bar of one run, drawn from its first progress on."""

from types import TracebackType
from typing import Self

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from windup.tools.terminal.output import console


class RunBar:
    """Shows how far a run is; nothing appears before the first call.

    Args:
        label: Text before the bar.
        show: Draw it, on a terminal. It is drawn from a thread, so a loop on the wall's time should
            have none.
    """

    def __init__(self, label: str, show: bool) -> None:
        self._label = label
        self._progress = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TextColumn("{task.fields[note]}"),
            console=console,
            transient=True,
            disable=not (show and console.is_terminal),
        )

    def __call__(self, done: int, total: int, note: str) -> None:
        """Show that so much of the total is done, with a note."""
        if not self._progress.tasks:
            self._progress.start()
            self._progress.add_task(self._label, total=total, note=note)
        task = self._progress.task_ids[0]
        self._progress.update(task, completed=done, total=total, note=note)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._progress.tasks:
            self._progress.stop()
