"""The picture of a run: the joints that move most, their torque, the base, the contacts."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from windup.hal.errors import UsageError
from windup.hal.joints import Array
from windup.tools.terminal.picture import SUFFIXES, load_pyplot, save_picture

MOST: Final = 6
"""Number of joints that are drawn."""


def draw_run(
    path: Path,
    title: str,
    joints: Sequence[str],
    contacts: Sequence[str],
    arrays: Mapping[str, Array],
) -> None:
    """Draw the arrays of a run into an image file; see `run_data.RunData`.

    Raises:
        UsageError: matplotlib is not installed, or the suffix is not that of a picture.
        OutputError: The file cannot be written.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise UsageError(f"{path}: name the picture {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}")
    pyplot = load_pyplot("report.plot")
    figure, axes = pyplot.subplots(4, 1, sharex=True, figsize=(9, 11), constrained_layout=True)
    axes[0].set_title(title)
    shown = _busiest(arrays["position"])
    _draw_joints(axes[0], joints, shown, arrays)
    _draw(axes[1], arrays["time"], arrays["torque"][:, shown], [joints[i] for i in shown])
    _draw(axes[2], arrays["time"], arrays["base_position"], "xyz")
    _draw(axes[3], arrays["time"], arrays["contacts"], contacts)
    for axis, label in zip(
        axes, ("joint angle [deg]", "torque [N m]", "base [m]", "contacts [N]"), strict=True
    ):
        axis.set_ylabel(label)
    axes[-1].set_xlabel("time [s]")
    try:
        save_picture(path, figure, dpi=110)
    finally:
        pyplot.close(figure)


def _busiest(position: Array) -> list[int]:
    """Return the indices of the joints that move through the largest angles, in their order."""
    if not len(position):
        return []
    ranges = np.nan_to_num(np.ptp(position, axis=0))
    return sorted(int(i) for i in np.argsort(-ranges, kind="stable")[:MOST])


def _draw_joints(
    axis: Any, joints: Sequence[str], shown: Sequence[int], arrays: Mapping[str, Array]
) -> None:
    """Draw measured angles as lines, and the angles that were asked for dotted."""
    for index in shown:
        measured = np.degrees(arrays["position"][:, index])
        (line,) = axis.plot(arrays["time"], measured, label=joints[index], linewidth=1.2)
        asked = np.degrees(arrays["position_asked"][:, index])
        axis.plot(arrays["time"], asked, color=line.get_color(), linestyle=":", linewidth=1.0)
    _add_legend(axis)


def _draw(axis: Any, time: Array, columns: Array, names: Sequence[str]) -> None:
    """Draw the columns that were measured."""
    for column, name in zip(columns.T, names, strict=True):
        if np.isfinite(column).any():
            axis.plot(time, column, label=name, linewidth=1.2)
    _add_legend(axis)


def _add_legend(axis: Any) -> None:
    if axis.get_legend_handles_labels()[0]:
        axis.legend(loc="upper right", fontsize="small", ncols=2)
