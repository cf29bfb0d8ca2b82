"""Steering: converts a guide's command into scalings and targets of the step that begins."""

from dataclasses import dataclass, field

import numpy as np

from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.style import Styling
from windup.control.regulation.step_record import StepRecord, StepStart
from windup.control.steering.course import Course
from windup.control.steering.guide import Guide, Place, WalkCommand
from windup.control.steering.incline import InclineControl
from windup.control.steering.side import SideControl
from windup.control.steering.slip import SlipControl
from windup.control.steering.speed import SpeedControl
from windup.hal.joints import Array

QUIET = 3  # steps on the spot before the walk counts as at rest
STEP_SECONDS = 0.3  # assumed duration of a step until one has been measured


@dataclass
class Steering:
    """Speed, sideways speed, course and style of a walk.

    Attributes:
        gait: The gait.
        guide: Source of the command, asked once per step.
        speed: Control of the forward speed.
        side: Control of the sideways speed.
        style: Styles.
        course: Control of the heading, or None if the gait cannot turn.
        incline: Slope compensation, or None if the gait has none.
        slip: Slip detection, or None if the gait has none.
        command: Last command of the guide.
    """

    gait: Gait
    guide: Guide
    speed: SpeedControl
    side: SideControl
    style: Styling
    course: Course | None = None
    incline: InclineControl | None = None
    slip: SlipControl | None = None
    command: WalkCommand = field(default_factory=WalkCommand, init=False)
    _quiet: int = field(default=0, init=False)
    _duration: float = field(default=STEP_SECONDS, init=False)

    @property
    def can_rest(self) -> bool:
        """True if the gait can step on the spot, and so come to rest."""
        table = self.gait.file.speed
        return table is not None and table.rows[0].speed <= 0.0 <= table.rows[-1].speed

    @property
    def resting(self) -> bool:
        """True after more than `QUIET` steps on the spot under a stop command."""
        return self._quiet > QUIET

    def reset(self) -> None:
        """Start over at rest."""
        self._quiet = 0
        self.speed.reset()
        self.side.reset()
        self.style.reset()
        if self.course is not None:
            self.course.reset()
        if self.incline is not None:
            self.incline.reset()
        if self.slip is not None:
            self.slip.reset()

    def begin_step(self, start: StepStart) -> None:
        """Get the guide's command, and ramp toward it by one step's change."""
        command = self.guide.command(Place(start.position[:2], start.heading, self.speed.present))
        self.command = command
        self.speed.command(0.0 if command.stop else command.speed)
        self.speed.begin_step()
        self.side.begin_step(0.0 if command.stop else command.side)
        self.style.begin_step(start.time, {} if self.slip is None else self.slip.styles())
        if self.course is not None:
            self.course.begin_step(command, start.heading, self._duration)
        still = command.stop and abs(self.speed.present) + abs(self.side.present) < 1e-6
        self._quiet = self._quiet + 1 if still else 0

    def scale(self, start: StepStart) -> Array:
        """Return the (p,) scalings of the step, before balance is added."""
        scale = self.speed.scale() + self.side.scale() + self.style.scale()
        if self.incline is not None:
            scale[self.gait.index(self.incline.law.perturbation)] += self.incline.present
        course = self.course
        if course is not None:
            scale[self.gait.index(course.perturbation)] += course.scale(start.heading)
            for name, value in (course.turn.spread if course.turn else {}).items():
                scale[self.gait.index(name)] += value * abs(float(np.degrees(course.rate)))
        return scale

    def targets(self, base: dict[str, float], *, swing_is_left: bool) -> dict[str, float]:
        """Return the targets of the step by name: `base`, the speed table's, and additions."""
        targets = {**base, **self.speed.targets()}
        for added in (
            self.speed.shifts(),
            self.side.targets(swing_is_left=swing_is_left),
            self.style.targets(),
        ):
            for name, value in added.items():
                targets[name] = targets.get(name, 0.0) + value
        return targets

    def end_step(self, record: StepRecord) -> None:
        """Update the feedback from the step that has just ended."""
        self._duration = record.duration
        self.speed.measured(record.speed)
        self.side.measured(record.side)
        if self.incline is not None:
            self.incline.measured(record)
