"""What runs leave in the runtime folder, and when it goes: nobody else tidies it up.

A ring stays readable after its run, for `windup health`. It is finished when its session has been
closed or its process is dead; finished rings go after an hour, or sooner, the oldest first, when
there are many. Files that were being made by a process that is dead, and locks that nobody holds,
go too.
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
from windup.hal.telemetry.ring import TelemetryReader

KEPT: Final = 3600.0
"""How long a finished ring is kept, s."""
FILES: Final = 16
"""So many rings are kept at most, while they are finished."""
BYTES: Final = 64 * 2**20
"""So many bytes of rings."""
SPARE: Final = 60.0
"""How long a lock is left alone after it was last used, s."""


@dataclass(frozen=True)
class Ring:
    """A ring in the folder.

    Attributes:
        path: Its file.
        size: Bytes.
        used: When it was last written, s since 1970.
        finished: Nobody will write it again.
    """

    path: Path
    size: int
    used: float
    finished: bool


def remove_leftovers(own: Path, now: float | None = None) -> None:
    """Remove what earlier runs have left in the runtime folder.

    Args:
        own: The ring of the robot that is opened, in that folder; it is replaced, not removed.
        now: The time, s since 1970; by default that of the clock.
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
    """Return whether a process is there; one that began after `since`, s since 1970, is another."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return since is None  # somebody else's by now: rings are their owner's alone
    began = _began(pid)
    return since is None or began is None or began <= since + 1.0


def _rings(folder: Path, own: Path) -> Iterator[Ring]:
    """Yield the rings of a folder; what cannot be read counts as finished when it was made."""
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
    """Remove the file of a lock that nobody holds; who opens it meanwhile sees that it is gone."""
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
    """Return when a process began, s since 1970; None where the system does not say."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        boot = Path("/proc/stat").read_text().partition("btime ")[2].split()[0]
    except (OSError, IndexError):
        return None
    return float(boot) + float(stat[19]) / os.sysconf("SC_CLK_TCK")
