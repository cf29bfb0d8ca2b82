"""A runtime in a process of its own, in a folder of its own."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from windup.hal.stopping.folder import private_folder
from windup.tools.remote.place import Place

PROGRAM = """
import sys
from pathlib import Path
from windup.hal.stopping import folder
folder.BASE = Path(sys.argv[1])
from windup.tools.cli import main
main(sys.argv[2:])
"""


def command(base: Path, *words: str) -> list[str]:
    """Return the arguments of a `windup` command whose private folder is in `base`."""
    return [sys.executable, "-c", PROGRAM, str(base), *words]


@contextmanager
def windup_up(base: Path, robot: str, *words: str) -> "Iterator[subprocess.Popen[str]]":
    """Bring a robot up; yield its process once it takes clients, and end it."""
    place = Place.of(robot, private_folder(base))
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    with subprocess.Popen(
        command(base, "up", robot, *words), stderr=subprocess.PIPE, env=environment, text=True
    ) as process:
        assert process.stderr is not None
        try:
            for line in process.stderr:
                if line.startswith(f"{robot}: holding") or line.startswith(f"{robot}: limp"):
                    break
            assert place.socket.exists(), process.stderr.read()
            yield process
        finally:
            process.terminate()
            process.wait(30.0)
