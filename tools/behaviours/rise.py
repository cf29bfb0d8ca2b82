"""Getting up from the front or the back."""

from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np

import windup.sim_twin.wire as wire
from windup.control.motions.play import PoseHolder
from windup.control.motions.reach import lean
from windup.hal.controller import Predictor
from windup.hal.errors import UsageError
from windup.hal.observation import Observation
from windup.robots import RobotDescription
from windup.sim_twin.wire.shafts.twin_shaft import TwinPhysics
from windup.tools.assembly.gaits import find_gait
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.behaviours.report import Report
from windup.tools.behaviours.run_record import RunRecord
from windup.tools.robot.robot import Robot
from windup.tools.terminal.quantities import Some

Side = Literal["front", "back"]
LOOK = 0.5  # s that it takes to know on which side one lies
SETTLE = 1.0  # s until a twin that was put down lies still
STAND = 1.5  # s to stand in the end


@dataclass(frozen=True, kw_only=True)
class RiseOptions:
    """Options of getting up."""

    lying: Side | None = None
    """Lay the twin on this side first; a robot lies as it does."""
    tries: Some = 3
    """How often, before it is given up."""


class Rise(Behaviour[RiseOptions]):
    """Look on which side it lies, play get_up_front or get_up_back, and stand."""

    name, Options, done = "rise", RiseOptions, "stand"

    def build(
        self, robot: RobotDescription, options: RiseOptions, predictor: Predictor | None
    ) -> PoseHolder:
        """Return the last of its controllers, which stands.

        Raises:
            UsageError: The robot cannot get up by itself.
        """
        if robot.fixed:
            raise UsageError(f"{robot.name} cannot get up: its base is fixed")
        motions = [f"get_up_{side}" for side in get_args(Side)]
        if missing := set(motions) - set(robot.gaits()):
            raise UsageError(
                f"{robot.name} cannot get up by itself, for it has no gait "
                f"{' and '.join(sorted(missing))}: put it on its feet"
            )
        for motion in motions:
            find_gait(robot, motion)
        return PoseHolder(robot.joints, robot.stance)

    def perform(self, run: RunRecord[RiseOptions]) -> None:
        """Get up, and stand."""
        robot, options = run.robot, run.options
        if options.lying is not None:
            lay(robot, options.lying)
        run.disturb_twin()
        began = robot.backend.clock.now()
        result = run.measured = {"robot": robot.description.name, "seed": robot.seed}
        result |= {"up": False, "sides": [], "reason": "interrupted", "peak_load": 0.0}
        try:
            rise(robot, options.tries, result)
        finally:
            result["seconds"] = robot.backend.clock.now() - began

    def report(self, run: RunRecord[RiseOptions]) -> Report:
        """Return whether it stands, and from which sides it got up."""
        result = run.measured
        return Report(result["up"], result["reason"], result, (format_rise(result),))


def rise(robot: Robot, tries: int, report: dict[str, Any]) -> None:
    """Get up in at most so many tries, and stand; keep `report` true.

    Args:
        robot: The robot; it may stand already.
        tries: How many.
        report: "up" whether it stands, "sides" it lay on, "reason", "peak_load".
    """
    for _ in range(tries):
        side = side_of(robot)
        if side is None:
            break
        report["sides"].append(side)
        played = robot.play(f"get_up_{side}")
        report["reason"] = played.reason
        report["peak_load"] = max(report["peak_load"], played.load.peak)
        if report["reason"] == "done":
            break
    else:
        return
    report["reason"] = robot.stand(STAND).reason
    report["up"] = report["reason"] == "done" and not robot.fallen


def side_of(robot: Robot) -> Side | None:
    """Return on which side the robot lies, or None where it stands.

    It holds the pose that it has, for as long as the estimate of its attitude takes.
    """
    seen: list[Observation] = []
    robot.watch.append(look := seen.append)
    pose = robot.backend.read().joints.position
    robot.run(PoseHolder(robot.description.joints, pose, ramp=0.0), LOOK, down=True, needs_imu=True)
    robot.watch.remove(look)
    if not robot.fallen:
        return None
    forward, _ = lean(seen[-1])
    return "front" if forward > 0.0 else "back"


def lay(robot: Robot, side: Side) -> None:
    """Put a twin on the floor, with its joints about as a limp robot has them.

    Raises:
        UsageError: This is a robot, not a twin.
    """
    twin = robot.twin
    if robot.stack.wired:
        physics = wire.find_world(robot.stack.world).physics
        assert isinstance(physics, TwinPhysics)
        physics.held = False  # nobody holds it: it lies
    joints = robot.description.joints
    pose = np.clip(np.zeros(len(joints)), joints.lower, joints.upper)
    twin.lay_down(side == "front", pose, noise=robot.noise, seed=robot.seed)
    robot.backend.clock.wait_until(robot.backend.clock.now() + SETTLE)


def format_rise(row: dict[str, Any]) -> str:
    """Return the line for people about getting up."""
    how = "stood already" if row["up"] else row["reason"]
    if row["sides"]:
        sides = ", then ".join(row["sides"])
        verb = "is up from its" if row["up"] else "did not get up from its"
        how = f"{verb} {sides} after {row['seconds']:.1f} s: {row['reason']}"
    return f"{row['robot']} {how}"


RISE = Rise()
