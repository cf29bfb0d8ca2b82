"""The picture of a robot: a 3D view, a rear view, a side view, and the names of its joints.

It is drawn with matplotlib and needs no OpenGL.
"""

from pathlib import Path
from typing import Any, Final

import numpy as np

from windup.tools.checking.outline import Outline
from windup.tools.terminal.picture import load_pyplot, save_picture

SIDES: Final = (("left", "tab:blue"), ("right", "tab:orange"), ("middle", "0.35"))
"""Colours of joint axes by their side; left is y > 0."""
MIDDLE = 1e-3
"""Maximum distance from the middle of a joint that belongs to neither side, m."""
ARROW = 0.11
"""Length of an axis, as a share of the largest extent of the robot."""


def draw_robot(path: Path, title: str, outline: Outline) -> None:
    """Draw an outline into the image file at `path`.

    Raises:
        UsageError: There is no matplotlib.
        OutputError: The file cannot be written.
    """
    pyplot = load_pyplot()
    figure = pyplot.figure(figsize=(13, 7.5), constrained_layout=True)
    grid = figure.add_gridspec(2, 3, width_ratios=(1.7, 1.0, 0.6))
    _draw_space(figure.add_subplot(grid[:, 0], projection="3d"), outline)
    _draw_flat(figure.add_subplot(grid[0, 1]), outline, 1, "to the left, y [m]")
    _draw_flat(figure.add_subplot(grid[1, 1]), outline, 0, "forward, x [m]")
    _list_joints(figure.add_subplot(grid[:, 2]), outline)
    figure.suptitle(title)
    try:
        save_picture(path, figure, dpi=110)
    finally:
        pyplot.close(figure)


def _arrows(outline: Outline) -> Any:
    """Return the ends (n, 3) of the drawn joint axes."""
    size = float(np.ptp(outline.points, axis=0).max())
    return outline.anchors + ARROW * size * outline.axes


def _colours(outline: Outline) -> list[str]:
    """Return the colour of each joint."""
    left, right, middle = (colour for _, colour in SIDES)
    y = outline.anchors[:, 1] - outline.com[1]
    return [left if at > MIDDLE else right if at < -MIDDLE else middle for at in y]


def _draw_space(axes: Any, outline: Outline) -> None:
    """Draw the 3D view, from the front left."""
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    axes.add_collection3d(Line3DCollection(outline.edges, colors="0.8", linewidths=0.5))
    axes.add_collection3d(Line3DCollection(outline.links, colors="0.2", linewidths=2.0))
    soles = Poly3DCollection(list(outline.soles.values()), alpha=0.5, facecolor="tab:green")
    axes.add_collection3d(soles)
    arrows = np.stack((outline.anchors, _arrows(outline)), axis=1)
    colours = _colours(outline)
    axes.add_collection3d(Line3DCollection(arrows, colors=colours, linewidths=1.8))
    for number, (tip, colour) in enumerate(zip(arrows[:, 1], colours, strict=True), 1):
        axes.text(*tip, str(number), color=colour, fontsize=8)
    x, y, z = outline.com
    axes.plot([x, x], [y, y], [outline.floor, z], color="tab:red", linestyle=":")
    axes.plot([x], [y], [z], marker="o", color="tab:red")
    low, high = outline.points.min(axis=0), outline.points.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", aspect="equal")
    axes.view_init(elev=18, azim=35)
    axes.locator_params(nbins=4)


def _draw_flat(axes: Any, outline: Outline, across: int, label: str) -> None:
    """Draw the rear view (`across` is 1) or the view from the right (0), to scale."""
    from matplotlib.collections import LineCollection

    plane = [across, 2]
    axes.add_collection(
        LineCollection(list(outline.edges[:, :, plane]), colors="0.8", linewidths=0.5)
    )
    axes.add_collection(
        LineCollection(list(outline.links[:, :, plane]), colors="0.2", linewidths=1.8)
    )
    arrows = np.stack((outline.anchors, _arrows(outline)), axis=1)[:, :, plane]
    axes.add_collection(LineCollection(list(arrows), colors=_colours(outline), linewidths=1.6))
    for sole in outline.soles.values():
        ring = np.concatenate((sole, sole[:1]))[:, plane]
        axes.plot(ring[:, 0], ring[:, 1], color="tab:green", linewidth=4, alpha=0.6)
    at, height = outline.com[plane]
    axes.plot([at, at], [outline.floor, height], color="tab:red", linestyle=":")
    axes.plot([at], [height], marker="o", color="tab:red")
    axes.autoscale()
    axes.set(xlabel=label, ylabel="z [m]", aspect="equal")
    axes.locator_params(axis="x", nbins=2)
    axes.tick_params(labelsize=8)
    if across == 1:
        axes.invert_xaxis()  # its left side is on the left


def _list_joints(axes: Any, outline: Outline) -> None:
    """Write the names of the joints and a legend."""
    lines = [*enumerate(outline.joints, 1)]
    colours = _colours(outline)
    axes.axis("off")
    step = 1.0 / max(len(lines) + 7, 24)
    for row, (number, name) in enumerate(lines):
        axes.text(0.0, 1.0 - row * step, f"{number} {name}", color=colours[row], fontsize=9)
    words = [
        *((f"axis of a joint: {side}", colour) for side, colour in SIDES),
        ("centre of mass", "tab:red"),
        ("sole", "tab:green"),
        ("positive rotation: right-hand rule", "0.0"),
        ("about the drawn axis", "0.0"),
    ]
    for row, (word, colour) in enumerate(words, len(lines) + 1):
        axes.text(0.0, 1.0 - row * step, word, color=colour, fontsize=8, style="italic")
