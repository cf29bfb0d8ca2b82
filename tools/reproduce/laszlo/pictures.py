"""Pictures that several figures share: hip plots, tables of steps, marks of a fall."""

from typing import Any

import numpy as np

from windup.tools.reproduce.laszlo.jobs import walked
from windup.tools.reproduce.laszlo.recorder import column
from windup.tools.reproduce.study.figure import Result

HIP_EVERY = 8  # samples of a trace: 0.16 s, as in the thesis
HALF = 0.5  # m, half a hip line; "approximately 1 meter"


def hip_plot(axis: Any, result: Result, label: str, color: str = "tab:blue") -> None:
    """Draw where the pelvis was and how it faced, from above (Fig. 4.3)."""
    x, y, yaw = (column(result, name)[::HIP_EVERY] for name in ("x", "y", "yaw"))
    axis.plot(
        x, y, color=color, linewidth=1.2, label=f"{label}{'' if walked(result) else ' (fell)'}"
    )
    dx, dy = -HALF * np.sin(yaw), HALF * np.cos(yaw)
    axis.plot([x - dx, x + dx], [y - dy, y + dy], color=color, linewidth=0.4, alpha=0.6)
    axis.set(xlabel="x [m]", ylabel="y [m]")
    axis.set_aspect("equal", adjustable="datalim")


def steps_text(results: list[Result]) -> str:
    """Return a cell of a table of steps: how many seeds walked, and the steps."""
    if not results:
        return "-"
    steps = sorted(result["steps"] for result in results)
    span = str(steps[0]) if steps[0] == steps[-1] else f"{steps[0]}-{steps[-1]}"
    return f"{sum(walked(result) for result in results)}/{len(results)}: {span}"


def numbers(values: Any, form: str = ".2f") -> str:
    """Return numbers as a list to read; '-' for none."""
    return ", ".join(format(value, form) for value in values) or "-"
