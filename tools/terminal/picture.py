"""Pictures of runs: whether one can be drawn is asked before anything moves."""

from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from windup.hal.errors import UsageError
from windup.tools.terminal.writing import check_writable, writing

SUFFIXES: Final = (".png", ".pdf", ".svg", ".jpg", ".jpeg", ".webp")
"""How the names of picture files end."""


def check_picture(path: Path | None) -> None:
    """Raise before anything runs if no picture could be drawn into a file.

    Raises:
        UsageError: There is no matplotlib, the suffix is none of a picture, or the file cannot be
            written.
    """
    if path is None:
        return
    _check_installed("--plot")
    if path.suffix.lower() not in SUFFIXES:
        raise UsageError(f"--plot {path}: name it {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}")
    check_writable(path)


def load_pyplot(wanted_by: str = "--plot") -> Any:
    """Return `matplotlib.pyplot`, drawing into memory.

    Raises:
        UsageError: There is no matplotlib.
    """
    _check_installed(wanted_by)
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    return pyplot


def save_picture(path: Path, figure: Any, **options: Any) -> None:
    """Write a figure into a file.

    Raises:
        OutputError: It cannot be written.
    """
    with writing(path):
        figure.savefig(path, **options)


def _check_installed(wanted_by: str) -> None:
    if find_spec("matplotlib") is None:
        raise UsageError(f"{wanted_by} needs matplotlib: pip install 'windup-robotics[plot]'")
