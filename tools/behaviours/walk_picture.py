"""The picture of a walk: path, regulation variables, foot contacts."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from windup.hal.contacts import ContactSensors
from windup.hal.geometry.quaternion import roll_pitch_yaw
from windup.hal.observation import Observation
from windup.tools.robot.walk_report import WalkReport
from windup.tools.terminal.picture import load_pyplot, save_picture

TRACE = 0.02  # s between samples of path and contacts


@dataclass
class Trace:
    """Samples of a run, for its picture.

    Attributes:
        contacts: The robot's contact sensors.
        times: s.
        base: Base position and heading: x, y, rad.
        feet: Which feet are down.
    """

    contacts: ContactSensors
    times: list[float] = field(default_factory=list)
    base: list[tuple[float, float, float]] = field(default_factory=list)
    feet: list[list[bool]] = field(default_factory=list)

    def add(self, observation: Observation) -> None:
        """Keep a sample every now and then."""
        base = observation.base
        if base is None or (self.times and observation.time < self.times[-1] + TRACE):
            return
        yaw = roll_pitch_yaw(base.orientation)[2]
        self.times.append(observation.time)
        self.base.append((float(base.position[0]), float(base.position[1]), yaw))
        self.feet.append([bool(down) for down in self.contacts.feet_down(observation.contacts)])


def plot_walk(path: Path, report: WalkReport, trace: Trace) -> None:
    """Draw a walk into the image file at `path`.

    Raises:
        UsageError: There is no matplotlib.
        OutputError: The file cannot be written.
    """
    pyplot = load_pyplot()
    figure, axes = pyplot.subplots(3, 1, figsize=(9, 10), constrained_layout=True)
    _draw_path(axes[0], report, trace)
    _draw_regulation(axes[1], report)
    _draw_contacts(axes[2], trace)
    try:
        save_picture(path, figure, dpi=110)
    finally:
        pyplot.close(figure)


def _draw_path(axis, report: WalkReport, trace: Trace) -> None:  # type: ignore[no-untyped-def]
    """Draw the thesis' hip plot: pelvis and its line of hips, from above (Laszlo, Fig. 4.3)."""
    base = np.array(trace.base).reshape(-1, 3)
    axis.plot(base[:, 0], base[:, 1], color="tab:blue", linewidth=1.5)
    half = 0.03 * max(np.ptp(base[:, 0]), 0.5) if len(base) else 0.0
    for x, y, yaw in base[:: max(len(base) // 60, 1)]:
        dx, dy = -half * np.sin(yaw), half * np.cos(yaw)
        axis.plot([x - dx, x + dx], [y - dy, y + dy], color="0.4", linewidth=0.7)
    speed = report.speed
    pace = "" if speed is None else f", {speed:.2f} m/s"
    axis.set_title(
        f"{report.robot.description.title}, gait {report.walker.gait.name!r}: "
        f"{report.walker.steps} steps{pace}, {report.loop.reason}"
    )
    axis.set(xlabel="forward [m]", ylabel="left [m]", aspect="equal")
    low, high = axis.get_ylim()
    axis.set_ylim(min(low, -0.2), max(high, 0.2))


def _draw_regulation(axis, report: WalkReport) -> None:  # type: ignore[no-untyped-def]
    """Draw the regulation variables and their targets against the step number."""
    records = report.walker.records
    steps = np.arange(1, len(records) + 1)
    for column, variable in enumerate(report.walker.regulation):
        values = [record.regulation[column] for record in records]
        line = axis.plot(steps, values, marker=".", label=f"{variable.name} [{variable.unit}]")
        targets = [record.target[column] for record in records]
        axis.plot(steps, targets, color=line[0].get_color(), linestyle=":")
    axis.set(xlabel="step", ylabel="regulation variables (dotted: targets)")
    if records and report.walker.regulation:
        axis.legend(loc="upper right", fontsize="small", ncols=2)


def _draw_contacts(axis, trace: Trace) -> None:  # type: ignore[no-untyped-def]
    """Draw which foot is on the ground, over time."""
    feet = np.array(trace.feet, dtype=bool).reshape(len(trace.times), -1)
    for row, name in enumerate(trace.contacts.foot_names):
        axis.fill_between(
            trace.times, row + 0.1, row + 0.9, where=feet[:, row], step="post", color="0.3"
        )
        axis.text(0.005, (row + 0.5) / 2.0, name, transform=axis.transAxes, va="center")
    axis.set(xlabel="time [s]", yticks=[], ylim=(0, 2), title="feet on the ground")
