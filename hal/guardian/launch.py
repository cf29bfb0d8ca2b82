"""Starts the guardian process: what it inherits from its host, and what not."""

import os
import subprocess
import sys
from collections.abc import Sequence

from windup.hal.guardian.child_path import child_python_path

BODY = "from windup.hal.guardian.process import main; main()"
STANDARD_ERROR = 2


def launch(locks: Sequence[int]) -> "subprocess.Popen[bytes]":
    """Start a guardian, which reads its standard input and answers on its standard output.

    It inherits the signal mask of this thread: blocked signals stay pending until it ignores them.

    Args:
        locks: Descriptors that it inherits, under the same numbers.

    Raises:
        OSError: There are too many processes or open files.
    """
    return subprocess.Popen(
        [sys.executable, "-P", "-c", BODY],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=None if _has_standard_error() else subprocess.DEVNULL,
        pass_fds=locks,
        env={**os.environ, "PYTHONPATH": child_python_path()},
        start_new_session=True,  # signals of the terminal go to the host only
    )


def _has_standard_error() -> bool:
    """Return whether descriptor 2 is really standard error.

    If it was closed, the next file opened got its number, maybe a servo port. Files that Python
    opens are not inheritable.
    """
    try:
        return os.get_inheritable(STANDARD_ERROR)
    except OSError:
        return False
