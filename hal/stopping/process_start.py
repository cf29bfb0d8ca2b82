"""When a process began: with its id, this tells it from a later process with the same id."""

from pathlib import Path

FIELD = 19
"""Index of the start time among the fields of /proc/PID/stat after the name; see proc(5)."""


def process_start(pid: int) -> int:
    """Return when process `pid` began, clock ticks since boot; 0 if there is no such process."""
    try:
        text = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return 0
    after_name = text.rpartition(")")[2].split()
    return 0 if after_name[0] in "ZX" else int(after_name[FIELD])
