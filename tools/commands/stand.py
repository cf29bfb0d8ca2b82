"""`windup stand`: move a robot into its stance and hold it."""

from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from windup.control.motions.play import PoseHolder
from windup.hal.observation import Observation
from windup.robots import load_robot
from windup.sim_twin.impact import ImpactGauge
from windup.tools.measures.fall_report import fall_result, format_fall
from windup.tools.options.common import Common
from windup.tools.options.twin_options import TwinOptions
from windup.tools.robot.robot import Robot
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.quantities import Duration


class Last:
    """What a robot's joints read last in a run, before it is stopped.

    Attributes:
        position: (n,) rad.
    """

    def __init__(self, robot: Robot) -> None:
        self.position = robot.backend.read().joints.position
        robot.watch.append(self._look)

    def _look(self, observation: Observation) -> None:
        self.position = observation.joints.position


@dataclass(frozen=True, kw_only=True)
class Stand(TwinOptions, Common):
    """Stand for some seconds; a twin that is pushed over says how hard it fell."""

    seconds: Duration = 5.0
    """How long to stand, with the second that it takes to get there; on a port, from then on."""

    def run(self) -> int:
        """Stand; returns the exit status."""
        rows = []
        for seed in self.all_seeds:
            rows.append(self._one(seed))
            console.print(format_stand(rows[-1]), markup=False, soft_wrap=True)
            if rows[-1]["fell"] and self.disturb() is not None:
                console.print(format_fall(rows[-1]))
            if rows[-1]["reason"] == "interrupted":
                break
        good = sum(row["reason"] == "done" and not row["fell"] for row in rows)
        if self.seeds is not None:
            console.print(f"{good} of {len(rows)} seeds stood")
        result = rows[0] if self.seeds is None else {"robot": self.robot, "rows": rows}
        write_json(self.json, "stand", result)
        if rows[-1]["reason"] == "interrupted":
            return 130
        return 0 if good == len(rows) else 1

    def _one(self, seed: int) -> dict[str, Any]:
        """Stand once; returns what came of it."""
        world = self.world(load_robot(self.robot), seed)
        with self.open_robot(seed, world=world) as robot:
            gauge = self._pushed(robot)
            pose = Last(robot)
            with suppress(KeyboardInterrupt):  # the robot has stopped
                self._stand(robot)
            report = robot.loop
            error = np.degrees(np.abs(pose.position - robot.description.stance))
            return {
                "robot": robot.description.name,
                "seed": seed,
                "fell": robot.fallen,
                "reason": report.reason,
                "sim_time_s": report.sim_time,
                "first_motion_s": report.first_motion,
                "wall_time_s": report.wall_time,
                "tick_ms": report.tick_ms(),
                "missed": report.missed if robot.paced else None,
                "largest_error_deg": float(error.max()),
                "largest_error_joint": robot.description.joints.names[int(error.argmax())],
            } | (fall_result(gauge) if gauge is not None else {})

    def _pushed(self, robot: Robot) -> ImpactGauge | None:
        """Arrange the pushes, if any; return what looks at how a twin falls under them."""
        disturb = self.disturb()
        if disturb is None:
            return None
        disturb(robot)
        return ImpactGauge(robot.twin)

    def _stand(self, robot: Robot) -> None:
        """Stand; what falls stiffly under a push falls until it lies, so that this can be seen."""
        stiff = self.disturb() is not None and not self.protect
        description = robot.description
        robot.run(PoseHolder(description.joints, description.stance), self.seconds, down=stiff)


def format_stand(result: dict[str, Any]) -> str:
    """Return the line for people about a stand."""
    total, first = result["sim_time_s"], result["first_motion_s"]
    if total <= 0.0:
        return f"{result['robot']} did not stand: {result['reason']}"
    verb = "fell after" if result["fell"] else "stood for"
    before = f", after a first motion of {first:.1f} s" if first > 0.0 else ""
    return (
        f"{result['robot']} {verb} {total - first:.1f} s{before}; farthest from its pose is "
        f"{result['largest_error_joint']} by {result['largest_error_deg']:.1f} degrees"
    )
