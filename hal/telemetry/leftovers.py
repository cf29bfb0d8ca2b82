"""Removes files that earlier runs have left in the runtime folder.

A ring stays readable after its run, for `windup health`. It is finished when its session has been
closed or its process is dead; finished rings are removed after an hour, or earlier, the oldest
first, if there are too many. Temporary files of dead processes, and lock files that are not held,
are removed too.
"""

import fcntl
import os
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from windup.hal.errors import TelemetryError
from windup.hal.telemetry.reader import TelemetryReader

KEPT: Final = 3600.0
"""Maximum time for which a finished ring is kept, s."""
FILES: Final = 16
"""Maximum number of rings; beyond it finished ones are removed."""
BYTES: Final = 64 * 2**20
"""Maximum total size of rings, bytes; beyond it finished ones are removed."""
SPARE: Final = 60.0
"""Minimum time since the last use of a lock file before it is removed, s."""


@dataclass(frozen=True)
class Ring:
    """A ring in the folder.

    Attributes:
        path: Path of its file.
        size: Size, bytes.
        used: Time when it was last written, s since 1970.
        finished: Whether it will not be written again.
    """

    path: Path
    size: int
    used: float
    finished: bool


def remove_leftovers(own: Path, now: float | None = None) -> None:
    """Remove files that earlier runs have left in the runtime folder.

    Args:
        own: The ring of the present run, in that folder; it is replaced, not removed.
        now: Present time, s since 1970; by default that of the clock.
    """
    folder, now = own.parent, time.time() if now is None else now
    for path in folder.glob("*@*"):
        if path.suffix[1:].isdigit() and not process_runs(int(path.suffix[1:])):
            _remove(path)
    for lock in folder.glob("adapter-*.lock"):
        _remove_unheld(lock, now)
    rings = sorted(_rings(folder, own), key=lambda ring: ring.used)
    count, total = len(rings) + 1, sum(ring.size for ring in rings)
    for ring in rings:
        full = count > FILES or total > BYTES
        if ring.finished and (full or now - ring.used > KEPT):
            _remove(ring.path)
            count, total = count - 1, total - ring.size


def process_runs(pid: int, since: float | None = None) -> bool:
    """Return whether process `pid` runs and began no later than `since`, s since 1970, if given."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return since is None  # of another user, so it is not the writer of a ring of this user
    began = _began(pid)
    return since is None or began is None or began <= since + 1.0


def _rings(folder: Path, own: Path) -> Iterator[Ring]:
    """Yield the rings of a folder; unreadable ones count as finished, with their file's time."""
    for path in folder.glob("*@*.ring"):
        if path == own:
            continue
        try:
            about = path.stat()
            with TelemetryReader(path) as reader:
                finished = reader.closed or not process_runs(
                    reader.header.pid, reader.header.started
                )
                last = reader.latest()
                used = reader.header.started if last is None else float(last["wall"])
        except FileNotFoundError:
            continue
        except TelemetryError:
            finished, used = True, about.st_mtime
        yield Ring(path, about.st_size, used, finished)


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink()


def _remove_unheld(path: Path, now: float) -> None:
    """Remove a lock file that is not held; a process that opens it meanwhile detects that."""
    with suppress(OSError):
        if now - path.stat().st_mtime < SPARE:
            return
        descriptor = os.open(path, os.O_RDWR | os.O_CLOEXEC)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            path.unlink()
        finally:
            os.close(descriptor)


def _began(pid: int) -> float | None:
    """Return the start time of a process, s since 1970; None if the system does not report it."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        boot = Path("/proc/stat").read_text().partition("btime ")[2].split()[0]
    except (OSError, IndexError):
        return None
    return float(boot) + float(stat[19]) / os.sysconf("SC_CLK_TCK")
