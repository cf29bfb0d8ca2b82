"""Limits a process and its children to a share of one core, by a control group of the kernel.

The group has the bandwidth control of the CPU controller (Linux, `admin-guide/cgroup-v2` and
`scheduler/sched-bwc`): in each period it may run for `share` times the period. Both versions of
control groups are supported.
"""

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from windup.hal.errors import UsageError

PERIOD: Final = 4_000
"""Period of the limit, us: short beside a tick; the kernel takes no limit below 1000 us."""
VERSION_1 = Path("/sys/fs/cgroup/cpu")
VERSION_2 = Path("/sys/fs/cgroup")
PATIENCE = 5.0
"""Longest time to wait until the processes of a group have ended, s."""


@contextmanager
def cpu_share(share: float) -> Iterator[Path]:
    """Create a control group, yield the file that takes the ids of its processes, and remove it.

    Args:
        share: Share of one core, such as 0.35.

    Raises:
        UsageError: This user may not create such a group.
    """
    parent = VERSION_1 if VERSION_1.is_dir() else VERSION_2
    group = parent / f"windup-{os.getpid()}"
    try:
        group.mkdir()
        _limit(group, round(share * PERIOD))
    except OSError as error:
        with suppress(OSError):
            group.rmdir()
        raise UsageError(
            f"limiting the CPU time takes a control group, and {group} cannot be made: "
            f"{error.strerror}; run this bench as root"
        ) from None
    try:
        yield group / "cgroup.procs"
    finally:
        _remove(group)


def _limit(group: Path, quota: int) -> None:
    """Let the processes of a group run for `quota` us in each period."""
    if (group / "cpu.cfs_period_us").exists():
        (group / "cpu.cfs_period_us").write_text(str(PERIOD))
        (group / "cpu.cfs_quota_us").write_text(str(quota))
    else:
        (group / "cpu.max").write_text(f"{quota} {PERIOD}")


def _remove(group: Path) -> None:
    """Remove a group once its processes have ended."""
    until = time.monotonic() + PATIENCE
    while True:
        try:
            return group.rmdir()
        except OSError:
            if time.monotonic() > until:
                return
        time.sleep(0.05)
