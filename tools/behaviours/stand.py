"""Standing: move into the stance and hold it."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from windup.control.motions.play import PoseHolder
from windup.hal.controller import Predictor
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.robots import RobotDescription
from windup.sim_twin.impact import ImpactGauge
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.behaviours.report import Report
from windup.tools.behaviours.run_record import RunRecord
from windup.tools.measures.fall_report import fall_result, format_fall
from windup.tools.terminal.quantities import Duration


@dataclass(frozen=True, kw_only=True)
class StandOptions:
    """Options of standing."""

    seconds: Duration = 5.0
    """How long to stand, with the second that it takes to get there; on a port, from then on."""


@dataclass
class Stood:
    """What is measured of a stand.

    Attributes:
        position: (n,) what the joints read last before the robot was stopped, rad.
        fall: Looks at how a twin falls that is pushed; None without a push.
    """

    position: Array
    fall: ImpactGauge | None

    def look(self, observation: Observation) -> None:
        """Look at a tick."""
        self.position = observation.joints.position


class Stand(Behaviour[StandOptions]):
    """Hold the stance; a twin that is pushed over says how hard it fell."""

    name, Options, done = "stand", StandOptions, "stood"

    def build(
        self, robot: RobotDescription, options: StandOptions, predictor: Predictor | None
    ) -> PoseHolder:
        """Return what holds the stance."""
        return PoseHolder(robot.joints, robot.stance)

    def perform(self, run: RunRecord[StandOptions]) -> None:
        """Stand; what falls stiffly under a push falls until it lies, so that this can be seen."""
        robot, pushed = run.robot, run.disturb is not None
        run.disturb_twin()
        fall = ImpactGauge(robot.twin) if pushed else None
        run.measured = stood = Stood(robot.backend.read().joints.position, fall)
        robot.watch.append(stood.look)
        holder = self.build(robot.description, run.options, None)
        robot.run(holder, run.options.seconds, down=pushed and not robot.protect)

    def report(self, run: RunRecord[StandOptions]) -> Report:
        """Return how it stood, and how it fell under a push."""
        robot, loop, stood = run.robot, run.robot.loop, run.measured
        error = np.degrees(np.abs(stood.position - robot.description.stance))
        result = {
            "robot": robot.description.name,
            "seed": robot.seed,
            "fell": robot.fallen,
            "reason": loop.reason,
            "sim_time_s": loop.sim_time,
            "first_motion_s": loop.first_motion,
            "wall_time_s": loop.wall_time,
            "tick_ms": loop.tick_ms(),
            "missed": loop.missed if robot.paced else None,
            "largest_error_deg": float(error.max()),
            "largest_error_joint": robot.description.joints.names[int(error.argmax())],
        }
        lines = [format_stand(result)]
        if stood.fall is not None:
            result |= fall_result(stood.fall)
            lines += [format_fall(result)] if result["fell"] else []
        good = loop.reason == "done" and not result["fell"]
        return Report(good, loop.reason, result, tuple(lines))


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


STAND = Stand()
