"""Walking footprints: what `step` and `footprints` have in common."""

from abc import abstractmethod
from typing import Any, TypeVar

import numpy as np

from windup.control.footprints.footprint_walker import FootprintWalker
from windup.control.footprints.footprints import Footprint
from windup.hal.controller import Predictor
from windup.robots import RobotDescription
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.behaviours.directed import (
    DirectedWalk,
    build_directed,
    feet_of,
    loop_rate,
    walk_prints,
)
from windup.tools.behaviours.report import Report
from windup.tools.behaviours.run_record import RunRecord

T = TypeVar("T")


class FootprintWalk(Behaviour[T]):
    """Walk footprints, and see how well each foot comes down."""

    done = "put every foot where it should be"

    @abstractmethod
    def prints(self, robot: RobotDescription, options: T, seed: int) -> list[Footprint]:
        """Return what to walk with a seed.

        Raises:
            UsageError: The options do not fit the robot.
            ConfigError: A file is invalid.
        """

    def build(
        self, robot: RobotDescription, options: T, predictor: Predictor | None
    ) -> FootprintWalker:
        """Return what walks the footprints of seed 0."""
        return build_directed(robot, self.prints(robot, options, 0))

    def opening(self, robot: RobotDescription, options: T) -> dict[str, Any]:
        """Return the rate that the controller is made for."""
        return {"rate": loop_rate(robot)}

    def perform(self, run: RunRecord[T]) -> None:
        """Walk the footprints of the seed from the stance."""
        robot, description = run.robot, run.robot.description
        prints = self.prints(description, run.options, robot.seed)
        controller = build_directed(description, prints)
        robot.start_at(controller.how.stance, needs_imu=True)
        run.disturb_twin()
        run.measured = walk = DirectedWalk(feet_of(description), controller.prints, controller.how)
        walk_prints(robot, controller, walk)

    def report(self, run: RunRecord[T]) -> Report:
        """Return where the feet came down: a line each if this is the only run."""
        walk: DirectedWalk = run.measured
        name = run.robot.description.name
        result = {"robot": name, "seed": run.robot.seed, **walk.record()}
        falls = format_falls(walk) if run.alone else []
        return Report(walk.good, walk.reason, result, (*falls, format_directed(name, walk)))


def format_falls(walk: DirectedWalk) -> list[str]:
    """Return a line for each foot that came down."""
    lines = []
    for number, fall in enumerate(walk.falls, 1):
        x, y, yaw = fall.place
        lines.append(
            f"{number:3d} {walk.names[fall.wanted.foot]:10s} at ({x:.3f}, {y:.3f}) m, "
            f"{np.degrees(yaw):.0f} degrees: {1e3 * fall.away:.1f} mm and "
            f"{fall.turned:.1f} degrees off"
        )
    return lines


def format_directed(name: str, walk: DirectedWalk) -> str:
    """Return how it went, in a sentence."""
    done = f"{name} took {len(walk.falls)} of {len(walk.prints)} steps in {walk.seconds:.1f} s"
    if walk.reason != "done":
        return f"{done} and {walk.reason}"
    away = max(fall.away for fall in walk.falls)
    turned = max(abs(fall.turned) for fall in walk.falls)
    fine = f", and {1e3 * walk.how.close:.0f} mm and {walk.how.turned:.0f} degrees are fine"
    verdict = "" if walk.good else fine
    return f"{done}; farthest off {1e3 * away:.1f} mm and {turned:.1f} degrees{verdict}"
