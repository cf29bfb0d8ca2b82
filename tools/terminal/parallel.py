"""Runs many items in parallel: one process per core, a progress bar, a clean end on Ctrl-C."""

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


def run_parallel(
    work: Callable[[Item], Result],
    items: list[Item],
    *,
    label: str,
    jobs: int | None = None,
) -> Iterator[tuple[Item, Result]]:
    """Yield each item with its result, in the order in which they finish.

    The caller can save each result at once: Ctrl-C ends the processes and loses only the items in
    progress.

    Args:
        work: A module-level function, run in another process.
        items: Its arguments.
        label: Text of the progress bar.
        jobs: Number of processes; one per core by default.

    Raises:
        WindupError: Raised by `work`, or a process has died.
    """
    if not items:
        return
    with Workers(label, total=len(items), jobs=jobs) as workers:
        yield from workers.run(work, items)


class Workers:
    """Processes that work on several lists of items, with one progress bar.

    Args:
        label: Text of the progress bar.
        total: Number of items in all lists.
        done: Number of them that were done before.
        jobs: Number of processes; one per core by default, and never more than items.
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
        # An interrupt may come while the first items are being submitted, before any is recorded.
        if kind is None and all(future.done() for future in self._futures):
            self._pool.shutdown()
            return
        self._pool.shutdown(wait=False, cancel_futures=True)
        for process in multiprocessing.active_children():
            process.kill()  # a run would treat SIGTERM as a request to end only

    def run(
        self, work: Callable[[Item], Result], items: list[Item]
    ) -> Iterator[tuple[Item, Result]]:
        """Yield each item with its result, in the order in which they finish.

        Raises:
            WindupError: Raised by `work`, or a process has died.
        """
        # Submit before the progress bar starts its thread: a process forked while that holds a lock
        # would inherit a lock that is never released.
        futures = {self._pool.submit(work, item): item for item in items}
        self._futures = set(futures)
        self._progress.start()
        try:
            for future in as_completed(futures):
                self._progress.advance(self._bar)
                yield futures[future], future.result()
        except BrokenProcessPool:
            raise WindupError(
                "a worker process died (out of memory?); run the command again to continue"
            ) from None

    def set_status(self, text: str) -> None:
        """Set the status text of the progress bar."""
        self._progress.update(self._bar, said=text)


def _quiet_worker() -> None:
    """Initialise a worker: ignore Ctrl-C, which the parent handles, and print nothing."""
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
