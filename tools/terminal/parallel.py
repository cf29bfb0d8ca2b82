"""Many runs side by side: one process a core, a progress bar, and a clean end on Ctrl-C."""

import logging
import multiprocessing
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from os import cpu_count
from typing import Any, Self, TypeVar

import mujoco
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from windup.hal.errors import WindupError
from windup.tools.terminal.output import console

Item = TypeVar("Item")
Result = TypeVar("Result")


def side_by_side(
    work: Callable[[Item], Result],
    items: list[Item],
    *,
    label: str,
    jobs: int | None = None,
) -> Iterator[tuple[Item, Result]]:
    """Yield each item with its result, in the order in which they finish.

    Whoever takes the results can save each one at once: Ctrl-C ends the processes and loses only
    what they were at.

    Args:
        work: A function of a module, run in another process.
        items: What to run it on.
        label: What the progress bar says.
        jobs: Number of processes; one a core by default.

    Raises:
        WindupError: From `work`, or a process has died.
    """
    if not items:
        return
    with Workers(label, total=len(items), jobs=jobs) as workers:
        yield from workers.run(work, items)


class Workers:
    """Processes that stay for several lists of items, under one progress bar.

    Args:
        label: What the progress bar says.
        total: Items to come, in all the lists.
        done: Items of them that were done before.
        jobs: Number of processes; one a core by default, and never more than items.
    """

    def __init__(self, label: str, *, total: int, done: int = 0, jobs: int | None = None) -> None:
        count = max(min(total, jobs or cpu_count() or 1), 1)
        self._pool = ProcessPoolExecutor(max_workers=count, initializer=_quiet_worker)
        self._progress = _bar()
        self._bar = self._progress.add_task(label, total=total, completed=done, said="")
        self._futures: set[Future[Any]] = set()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self._progress.stop()
        # An interrupt may come while the first items are being submitted, with none of them known.
        if kind is None and all(future.done() for future in self._futures):
            self._pool.shutdown()
            return
        self._pool.shutdown(wait=False, cancel_futures=True)
        for process in multiprocessing.active_children():
            process.kill()  # a run that it is at would only take SIGTERM for a wish to end

    def run(
        self, work: Callable[[Item], Result], items: list[Item]
    ) -> Iterator[tuple[Item, Result]]:
        """Yield each item with its result, in the order in which they finish.

        Raises:
            WindupError: From `work`, or a process has died.
        """
        # Submitted before the bar starts its thread: a process forked under it could inherit a
        # lock that nobody will ever release.
        futures = {self._pool.submit(work, item): item for item in items}
        self._futures = set(futures)
        self._progress.start()
        try:
            for future in as_completed(futures):
                self._progress.advance(self._bar)
                yield futures[future], future.result()
        except BrokenProcessPool:
            raise WindupError(
                "a worker process died (out of memory?); run again to go on"
            ) from None

    def say(self, text: str) -> None:
        """Let the progress bar say how it is going."""
        self._progress.update(self._bar, said=text)


def _quiet_worker() -> None:
    """Leave Ctrl-C to the parent, which ends us; print nothing."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    mujoco.set_mju_user_warning(logging.getLogger("mujoco").debug)
    console.quiet = True


def _bar() -> Progress:
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left:"),
        TimeRemainingColumn(),
        TextColumn("{task.fields[said]}"),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )
