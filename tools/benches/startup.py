"""What starting costs: each way in as a ratio to `python -c "import numpy"` of the same rounds.

Where one is too slow, `python -X importtime -c "..."` says which import it is.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Final, NamedTuple

from windup.tools.testing import PLUGIN


class Way(NamedTuple):
    """A way to start.

    Attributes:
        arguments: Of the Python interpreter.
        most: Ratio of its time to that of `base` which it may take.
        base: Name of what it is compared with.
    """

    arguments: tuple[str, ...]
    most: float
    base: str = "import numpy"


BASE: Final = "import numpy"
WITHOUT: Final = "pytest without the plugin"
CLI: Final = "from windup.tools.cli import main; main([{!r}])"
PYTEST: Final = ("-m", "pytest", "-q", "-p", "no:cacheprovider", "test_nothing.py")
WAYS: Final[dict[str, Way]] = {
    BASE: Way(("-c", "import numpy"), 1.0),
    "windup --help": Way(("-c", CLI.format("--help")), 2.5),
    "windup robots": Way(("-c", CLI.format("robots")), 4.0),
    "import windup.hal": Way(("-c", "import windup.hal"), 1.5),
    "from windup import Robot": Way(("-c", "from windup import Robot"), 4.0),
    WITHOUT: Way((*PYTEST, "-p", f"no:{PLUGIN}"), 1.0, WITHOUT),
    "pytest with the plugin": Way(PYTEST, 1.05, WITHOUT),
}
"""What is started, each in an interpreter of its own."""


def measure_startup(robot: str, times: int = 20) -> dict[str, Any]:
    """Return the ratio of each way to start, and whether all are within their limits.

    The rounds are interleaved, and the best of each way counts: noise only ever adds.

    Args:
        robot: Not used; every measure is given one.
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
    """Return how long an interpreter takes to run and end, s.

    Raises:
        CalledProcessError: It failed.
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
