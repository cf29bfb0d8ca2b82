"""Where a Python process that we start looks for modules."""

import os
import sys
from pathlib import Path

HOME = str(Path(__file__).parents[3])
"""The folder that has the package `windup`."""


def child_python_path() -> str:
    """Return the PYTHONPATH of a process that imports what this one can, as `python -P` does.

    An empty entry stands for the working folder. It is left out: a file there that is named like a
    module of the standard library, such as `socket.py`, would end the process.
    """
    paths = [path for path in sys.path if path]
    return os.pathsep.join(paths if HOME in paths else [*paths, HOME])
