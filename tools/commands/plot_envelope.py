"""The polar plot of what a robot survives in each direction."""

from math import pi
from pathlib import Path

from windup.tools.terminal.picture import load_pyplot, save_picture


def plot_envelope(
    path: Path, robot: str, directions: list[float], found: dict[str, list[float]]
) -> None:
    """Draw the largest impulses, N s, of each way over the directions, rad, into an image file.

    Raises:
        UsageError: There is no matplotlib.
        OutputError: The file cannot be written.
    """
    pyplot = load_pyplot()
    figure = pyplot.figure(figsize=(7, 7))
    axes = figure.add_subplot(projection="polar", theta_offset=0.5 * pi)  # forward is up
    for way, largest in found.items():
        around = [*directions, directions[0] + 2.0 * pi]
        axes.plot(around, [*largest, largest[0]], label=way, marker="o", markersize=3)
    axes.set_title(f"{robot}: largest impulse survived, N s")
    axes.legend(loc="lower right", bbox_to_anchor=(1.15, -0.1))
    try:
        save_picture(path, figure, bbox_inches="tight")
    finally:
        pyplot.close(figure)
