"""Times of the ways to start, as ratios to `python -c "import numpy"` of the same rounds.

`python -X importtime -c "..."` shows which imports one of them spends its time on.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Final, NamedTuple

from windup.tools.testing import PLUGIN

BASE: Final = "import numpy"


class StartCommand(NamedTuple):
    """A way to start.

    Attributes:
        arguments: Of the Python interpreter.
        most: Largest allowed ratio of its time to that of `base`.
        base: Name of the way that it is compared with.
    """

    arguments: tuple[str, ...]
    most: float
    base: str = BASE


WITHOUT: Final = "pytest without the plugin"
CLI: Final = "from windup.tools.cli import main; main([{!r}])"
STOP: Final = "from windup.tools.cli import run; run(['stop', 'nobody'])"
PYTEST: Final = ("-m", "pytest", "-q", "-p", "no:cacheprovider", "test_nothing.py")
WAYS: Final[dict[str, StartCommand]] = {
    BASE: StartCommand(("-c", "import numpy"), 1.0),
    "windup --help": StartCommand(("-c", CLI.format("--help")), 2.5),
    "windup stop ROBOT": StartCommand(("-c", STOP), 2.5),
    "windup robots": StartCommand(("-c", CLI.format("robots")), 4.0),
    "import windup.hal": StartCommand(("-c", "import windup.hal"), 1.5),
    "from windup import Robot": StartCommand(("-c", "from windup import Robot"), 2.0),
    WITHOUT: StartCommand((*PYTEST, "-p", f"no:{PLUGIN}"), 1.0, WITHOUT),
    "pytest with the plugin": StartCommand(PYTEST, 1.05, WITHOUT),
}
"""The ways to start, each in a new interpreter."""


def measure_startup(times: int = 20) -> dict[str, Any]:
    """Return the ratio of each way to start, and whether all are within their limits.

    The rounds are interleaved, and the shortest time of each way counts: noise only adds.

    Args:
        times: Number of rounds.
    """
    best = dict.fromkeys(WAYS, float("inf"))
    with tempfile.TemporaryDirectory(prefix="windup-") as folder:
        Path(folder, "test_nothing.py").write_text("def test_nothing():\n    pass\n")
        for _ in range(times):
            for name, way in WAYS.items():
                best[name] = min(best[name], _seconds(way.arguments, folder))
    ratios = {name: best[name] / best[way.base] for name, way in WAYS.items()}
    return {
        "numpy_ms": 1e3 * best[BASE],
        **{name: round(ratio, 3) for name, ratio in ratios.items() if WAYS[name].base != name},
        "met": all(ratios[name] <= way.most for name, way in WAYS.items()),
    }


def _seconds(arguments: tuple[str, ...], folder: str) -> float:
    """Return the time that an interpreter takes from its start to its end, s.

    Raises:
        CalledProcessError: It ended with an error.
    """
    begin = time.perf_counter()
    subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=True,
    )
    return time.perf_counter() - begin
