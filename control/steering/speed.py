"""Commanded speed: scalings and targets of a gait's speed table, with feedback of the speed."""

from dataclasses import dataclass, field

import numpy as np

from windup.control.pose_graph.gait import Gait
from windup.hal.errors import UsageError
from windup.hal.joints import Array


@dataclass
class SpeedControl:
    """Interpolates the gait's speed table and corrects one target by the measured speed.

    Attributes:
        gait: The gait; without a speed table all results are zero or empty.
        speed: Commanded speed, m/s, or None for the gait's default.
        correction: Present correction of the gait's `speed.correct` target.
        present: Ramped speed toward the commanded one, m/s.
    """

    gait: Gait
    speed: float | None = None
    correction: float = field(default=0.0, init=False)
    present: float = field(default=0.0, init=False)

    def __post_init__(self) -> None:
        table = self.gait.file.speed
        if table is None:
            if self.speed is not None:
                raise UsageError(
                    f"gait {self.gait.name!r} has no speed table; leave --speed away "
                    "or choose another --gait"
                )
            return
        self.speed = table.default if self.speed is None else self.speed
        if self.speed is None:
            return
        slowest, fastest = self.range
        if not slowest <= self.speed <= fastest:
            raise UsageError(
                f"speed {self.speed:g} m/s is outside the range of gait {self.gait.name!r}: "
                f"{slowest:g} .. {fastest:g} m/s"
            )

    @property
    def range(self) -> tuple[float, float]:
        """Slowest and fastest speed of the gait, m/s; both 0 without a table."""
        table = self.gait.file.speed
        return (table.rows[0].speed, table.rows[-1].speed) if table is not None else (0.0, 0.0)

    def command(self, speed: float | None) -> None:
        """Set the commanded speed, clipped to the gait's range, m/s; None changes nothing."""
        if speed is not None:
            self.speed = float(np.clip(speed, *self.range))

    def reset(self) -> None:
        """Start over at the table's initial speed, without correction."""
        table = self.gait.file.speed
        self.correction = 0.0
        self.present = 0.0 if table is None else table.begin

    def begin_step(self) -> None:
        """Ramp the present speed toward the commanded one by one step's change."""
        table = self.gait.file.speed
        if table is not None and self.speed is not None:
            change = np.clip(self.speed - self.present, -table.ramp, table.ramp)
            self.present += float(change)

    def scale(self) -> Array:
        """Return the (p,) scalings of the table for the present speed, corrected."""
        scale = np.zeros(len(self.gait.perturbations))
        for name in self._names("scale"):
            scale[self.gait.index(name)] = self._at("scale", name)
        table = self.gait.file.speed
        if table is not None and table.correct in self.gait.perturbations:
            scale[self.gait.index(table.correct)] += self.correction
        return scale

    def targets(self) -> dict[str, float]:
        """Return the targets of the table for the present speed, corrected, by name."""
        targets = {name: self._at("targets", name) for name in self._names("targets")}
        table = self.gait.file.speed
        if table is not None and table.correct in targets:
            targets[table.correct] += self.correction
        return targets

    def shifts(self) -> dict[str, float]:
        """Return the additions of the feedback to other targets (`speed.also`), by name."""
        table = self.gait.file.speed
        also = {} if table is None else table.also
        return {name: value * self.correction for name, value in also.items()}

    def measured(self, speed: float) -> None:
        """Update the correction by the speed of the step that has just ended, m/s."""
        table = self.gait.file.speed
        if table is not None and self.speed is not None:
            change = table.gain * (self.present - speed)
            self.correction = float(np.clip(self.correction + change, -table.limit, table.limit))

    def _names(self, kind: str) -> list[str]:
        rows = self.gait.file.speed.rows if self.gait.file.speed and self.speed is not None else []
        return sorted({name for row in rows for name in getattr(row, kind)})

    def _at(self, kind: str, name: str) -> float:
        assert self.gait.file.speed is not None and self.speed is not None
        rows = [row for row in self.gait.file.speed.rows if name in getattr(row, kind)]
        values = [getattr(row, kind)[name] for row in rows]
        return float(np.interp(self.present, [row.speed for row in rows], values))
