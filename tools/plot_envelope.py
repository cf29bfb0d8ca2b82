"""The polar plot of what a robot survives in each direction."""

from math import pi
from pathlib import Path

from hal.errors import UsageError


def plot_envelope(
    path: Path, robot: str, directions: list[float], found: dict[str, list[float]]
) -> None:
    """Draw the largest impulses, N s, of each way over the directions, rad, into an image file.

    Raises:
        UsageError: There is no matplotlib, or the file cannot be written.
    """
    try:
        import matplotlib
    except ImportError:
        raise UsageError("--plot needs matplotlib: pip install 'windup[plot]'") from None
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure = pyplot.figure(figsize=(7, 7))
    axes = figure.add_subplot(projection="polar", theta_offset=0.5 * pi)  # forward is up
    for way, largest in found.items():
        around = [*directions, directions[0] + 2.0 * pi]
        axes.plot(around, [*largest, largest[0]], label=way, marker="o", markersize=3)
    axes.set_title(f"{robot}: largest impulse survived, N s")
    axes.legend(loc="lower right", bbox_to_anchor=(1.15, -0.1))
    try:
        figure.savefig(path, bbox_inches="tight")
    except (OSError, ValueError) as error:
        raise UsageError(f"--plot {path}: {error}") from None
    finally:
        pyplot.close(figure)
