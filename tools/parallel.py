"""Many runs side by side: one process a core, a progress bar, and a clean end on Ctrl-C."""

import logging
import multiprocessing
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from os import cpu_count
from typing import TypeVar

import mujoco
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from hal.errors import UsageError, WindupError
from tools.output import console

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
        UsageError: `jobs` is below 1.
        WindupError: From `work`, or a process has died.
    """
    if jobs is not None and jobs < 1:
        raise UsageError(f"--jobs {jobs}: give 1 or more")
    if not items:
        return
    count = min(len(items), jobs or cpu_count() or 1)
    with ProcessPoolExecutor(max_workers=count, initializer=_quiet_worker) as pool:
        # Submitted before the bar starts its thread: a process forked under it could inherit a
        # lock that nobody will ever release.
        futures = {pool.submit(work, item): item for item in items}
        try:
            with _bar() as progress:
                bar = progress.add_task(label, total=len(items))
                for future in as_completed(futures):
                    progress.advance(bar)
                    yield futures[future], future.result()
        except BrokenProcessPool:
            raise WindupError(
                "a worker process died (out of memory?); run again to go on"
            ) from None
        finally:
            if not all(future.done() for future in futures):
                pool.shutdown(wait=False, cancel_futures=True)
                for process in multiprocessing.active_children():
                    process.terminate()


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
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )
