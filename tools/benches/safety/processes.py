"""Finds the processes that belong to an armed robot."""

from contextlib import suppress
from pathlib import Path
from typing import TypeGuard

from windup.hal.port.lock import AdapterLock


def guardian_of(port: str) -> int | None:
    """Return the process id of the guardian of a port, or None if there is none."""
    url = port.split(",")[0].partition("=")[2] if "=" in port else port
    lock = AdapterLock(url)
    try:
        return lock.note().pid or None
    finally:
        lock.close()


def child_with(parent: int, word: str) -> int | None:
    """Return the id of a child process whose command line contains a word, or None."""
    for task in Path(f"/proc/{parent}/task").glob("*/children"):
        with suppress(OSError):
            for child in task.read_text().split():
                if word.encode() in Path(f"/proc/{child}/cmdline").read_bytes():
                    return int(child)
    return None


def is_guardian(number: int) -> bool:
    """Return whether a process is a guardian; the lock of an adapter may name another one."""
    with suppress(OSError):
        return b"windup.hal.guardian" in Path(f"/proc/{number}/cmdline").read_bytes()
    return False


def alive(number: int | None) -> TypeGuard[int]:
    """Return whether a process is running and not a zombie."""
    if number is None:
        return False
    try:
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
