"""`windup push`: push a twin that stands or walks, and see whether it stays up."""

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from windup.hal.errors import UsageError
from windup.robots import load_robot
from windup.tools.assembly.stepping import WAYS, check_way
from windup.tools.behaviours.push import PUSH, PushOptions, push
from windup.tools.behaviours.push_edge import LIGHT, Search
from windup.tools.behaviours.push_trial import PushPlan
from windup.tools.commands.behaviour_command import BehaviourCommand
from windup.tools.commands.push_envelope import Envelope
from windup.tools.terminal.picture import check_picture
from windup.tools.terminal.quantities import Jobs, Some


@dataclass(frozen=True, kw_only=True)
class Push(PushOptions, BehaviourCommand):
    """Push a robot; it survives when only feet touch the ground and it rests, or walks on."""

    behaviour = PUSH
    envelope: bool = False
    """Find the largest impulse that it survives in each direction, for each of --ways."""
    directions: Some = 16
    """Directions of the envelope."""
    ways: tuple[str, ...] = WAYS
    """Ways of the envelope."""
    jobs: Jobs | None = None
    """Processes of the envelope; one a core by default."""
    plot: Path | None = None
    """Draw the envelope into an image file."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        if self.envelope == (self.impulse is not None):
            raise UsageError("give --impulse N_S, or --envelope to find the largest ones")
        if self.plot is not None and not self.envelope:
            raise UsageError("--plot draws an envelope: give --envelope, or leave it away")
        if self.envelope and self.during == "walk":
            raise UsageError("--envelope is for a robot that stands; leave --during walk away")
        check_picture(self.plot)
        for way in self.ways:
            check_way(way)

    def run(self) -> int:
        """Push; returns the exit status."""
        return self._envelope().run() if self.envelope else super().run()

    def plan(self, seed: int) -> PushPlan:
        """Return what is done with a seed."""
        return self.plan_for(load_robot(self.robot), seed)

    def trial(self, seed: int, plan: PushPlan) -> dict[str, Any]:
        """Return how one push of the envelope went; it ends at the first touch of the ground."""
        with self.open_behaving(seed) as robot:
            robot.protect = False
            result: dict[str, Any] = {"reason": "interrupted", "survived": False, "seed": seed}
            with suppress(KeyboardInterrupt):
                result = push(robot, self.options, plan)
        return result

    def _envelope(self) -> Envelope:
        """Return what is searched, in all directions and all ways."""
        with self.open_robot(self.seed) as robot:
            scale = max(round(float(robot.twin.model.body_mass.sum()) / LIGHT), 1)
        directions = (np.arange(self.directions) * 360.0 / self.directions).tolist()
        plan = self.plan(self.seed)
        searches = [
            Search(self.trial, self.seed, plan, way, direction, scale)
            for way in self.ways
            for direction in directions
        ]
        return Envelope(
            self.robot, directions, self.ways, searches, self.jobs, self.json, self.plot
        )
