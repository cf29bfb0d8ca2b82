"""`windup stand`: move a robot into its stance and hold it."""

from contextlib import suppress
from dataclasses import dataclass
from math import inf

import numpy as np

from hal.errors import UsageError
from tools.options import Common
from tools.output import console, write_json


@dataclass(frozen=True, kw_only=True)
class Stand(Common):
    """Stand for some seconds."""

    seconds: float = 5.0
    """How long to stand, with the second that it takes to get there."""

    def run(self) -> int:
        """Stand; returns the exit status."""
        if not 0.0 < self.seconds < inf:
            raise UsageError(f"--seconds {self.seconds:g}: give more than 0")
        with self.open_robot(self.seed) as robot:
            with suppress(KeyboardInterrupt):  # the robot has stopped
                robot.stand(self.seconds)
            report = robot.loop
            joints = robot.backend.read().joints
            error = np.degrees(np.abs(joints.position - robot.description.stance))
            result = {
                "robot": robot.description.name,
                "fell": robot.fallen,
                "reason": report.reason,
                "sim_time_s": report.sim_time,
                "wall_time_s": report.wall_time,
                "tick_ms": report.tick_ms(),
                "missed": report.missed if robot.paced else None,
                "largest_error_deg": float(error.max()),
                "largest_error_joint": robot.description.joints.names[int(error.argmax())],
            }
        verb = "fell" if result["fell"] else "stood"
        console.print(
            f"{self.robot} {verb} for {report.sim_time:.1f} s; farthest from its pose is "
            f"{result['largest_error_joint']} by {error.max():.1f} degrees"
        )
        write_json(self.json, "stand", result)
        if report.reason == "interrupted":
            return 130
        return 1 if result["fell"] else 0
