"""Putting together what walks footprints, walking them, and how well each foot came down."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import mujoco
import numpy as np

from windup.control.execution.executor import WalkExecutor
from windup.control.execution.leg_executor import LegExecutor
from windup.control.footprints.directed_file import Directed, ServoDirected
from windup.control.footprints.footprint_checks import FootprintChecks, outline
from windup.control.footprints.footprint_walker import FootprintWalker
from windup.control.footprints.footprints import Footprint
from windup.control.kinematics.limb_ik import LimbIk
from windup.control.kinematics.places import between, ground_places, seen_from
from windup.control.kinematics.soles import Soles
from windup.hal.errors import UnknownNameError
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.robots import RobotDescription
from windup.tools.assembly.robot_file import load_beside
from windup.tools.assembly.shape import check_walks
from windup.tools.assembly.state import state_of
from windup.tools.assembly.stepping import find_stepping
from windup.tools.assembly.torques import torque_executor
from windup.tools.robot.robot import Robot

FOOTPRINTS: Final = "footprints.toml"


def find_directed(robot: RobotDescription) -> Directed:
    """Return how `robot` walks footprints.

    Raises:
        UsageError: It has no footprints.toml.
        ConfigError: That file says something that cannot be.
    """
    kind = Directed if robot.drive.kind == "torque" else ServoDirected
    how = load_beside(robot, FOOTPRINTS, kind)
    if how.stance not in robot.poses:
        raise UnknownNameError(f"pose of {robot.name}", how.stance, robot.poses)
    return how


def feet_of(robot: RobotDescription) -> tuple[str, ...]:
    """Return the names of the feet of a robot that has two.

    Raises:
        UsageError: It has not.
    """
    check_walks(robot, "walk footprints")
    return tuple(foot.name for foot in robot.feet)


def limbs_of(robot: RobotDescription) -> list[LimbIk]:
    """Return the inverse kinematics of its legs."""
    return [LimbIk(robot.model, robot.base, foot.site) for foot in robot.feet]


def loop_rate(robot: RobotDescription) -> float | None:
    """Return the rate, Hz, of the loop that walks footprints; None is the robot's own."""
    return find_stepping(robot).rate if robot.drive.kind == "torque" else None


def build_checks(robot: RobotDescription) -> FootprintChecks:
    """Return what `robot` can step to.

    Raises:
        UsageError: It has not two feet, or no footprints.toml.
    """
    names, how, model = feet_of(robot), find_directed(robot), robot.model
    stance, limbs = robot.poses[how.stance], limbs_of(robot)
    soles = Soles(model, [foot.body for foot in robot.feet], robot.contacts)
    soles.update(stance, np.zeros_like(stance), np.array([0.0, 0.0, 1.0]))
    poses = [limb.forward(stance) for limb in limbs]
    seen = [
        (soles.position[soles.foot == k] - pose.position) @ pose.rotation
        for k, pose in enumerate(poses)
    ]
    middle = np.mean([pose.position for pose in poses], axis=0)
    homes = [np.array([*(pose.position - middle)[:2], 0.0]) for pose in poses]
    data = mujoco.MjData(model)
    data.qpos[:7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    data.qpos[7:] = stance
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    com = data.subtree_com[model.body(robot.base).id, :2].copy()
    outlines = [outline(points[:, :2]) for points in seen]
    return FootprintChecks(names, limbs, outlines, homes, stance, -com, how.height)


def build_directed(robot: RobotDescription, prints: Sequence[Footprint]) -> FootprintWalker:
    """Return the controller that walks footprints.

    Raises:
        UsageError: They cannot be walked by this robot.
    """
    build_checks(robot).check(prints)
    how = find_directed(robot)
    return FootprintWalker(_executor(robot, how), prints, how)


def _executor(robot: RobotDescription, how: Directed) -> WalkExecutor:
    """Return what realises the steps with the joints of `robot`."""
    stance = robot.poses[how.stance]
    if isinstance(how, ServoDirected):
        return LegExecutor(robot.joints, state_of(robot), limbs_of(robot), stance, how)
    return torque_executor(robot, stance)


@dataclass
class Footfall:
    """Where a foot came down, once the weight had gone on.

    Attributes:
        wanted: Its footprint.
        place: (3,) where it stands, seen from what its footprint is seen from.
    """

    wanted: Footprint
    place: Array

    @property
    def away(self) -> float:
        """How far from its place, m."""
        return float(np.hypot(*(self.place - self.wanted.place)[:2]))

    @property
    def turned(self) -> float:
        """How far turned, degrees."""
        return float(np.degrees(seen_from(self.wanted.place, self.place)[2]))

    def good(self, how: Directed) -> bool:
        """Return whether it is where it should be."""
        return self.away <= how.close and abs(self.turned) <= how.turned

    def record(self, names: tuple[str, ...]) -> dict[str, Any]:
        """Return it as programs read it."""
        return {
            "foot": names[self.wanted.foot],
            "wanted": _named(self.wanted.place),
            "place": _named(self.place),
            "away_m": self.away,
            "turned_deg": self.turned,
        }


@dataclass
class DirectedWalk:
    """How footprints were walked.

    Attributes:
        names: Names of the feet.
        prints: What should be walked.
        how: How close the feet have to come.
        falls: Where the feet came down: the twin's truth, or what a robot believes.
        reason: Why it ended.
        seconds: How long it took, s.
    """

    names: tuple[str, ...]
    prints: Sequence[Footprint]
    how: Directed
    falls: list[Footfall] = field(default_factory=list)
    reason: str = "interrupted"
    seconds: float = 0.0

    @property
    def good(self) -> bool:
        """Every foot came down where it should."""
        return len(self.falls) == len(self.prints) and all(
            fall.good(self.how) for fall in self.falls
        )

    def record(self) -> dict[str, Any]:
        """Return it as programs read it."""
        return {
            "steps": len(self.prints),
            "stepped": len(self.falls),
            "good": self.good,
            "largest_away_m": max((fall.away for fall in self.falls), default=None),
            "largest_turned_deg": max((abs(fall.turned) for fall in self.falls), default=None),
            "reason": self.reason,
            "seconds": self.seconds,
            "falls": [fall.record(self.names) for fall in self.falls],
        }


def walk_prints(robot: Robot, controller: FootprintWalker, walk: DirectedWalk) -> None:
    """Walk footprints, and look where the feet come down; `walk` is filled in on the way.

    A foot is looked at once it bears the weight, so that its slip counts; and seen from where the
    other one stood when it came down, for that one moves as soon as it bears nothing.

    Raises:
        WindupError: From the loop.
        KeyboardInterrupt: Somebody stopped the robot; `walk` says how far it came.
    """
    origin: list[Array] = []
    stances: list[Array] = []

    def until(observation: Observation) -> str | None:
        places = _places(robot, controller)
        if not origin:
            origin.append(between(*places))
        while controller.landed > len(stances):
            stances.append(places[1 - controller.prints[len(stances)].foot])
        while controller.stood > len(walk.falls):
            wanted = controller.prints[len(walk.falls)]
            seen = origin[0] if wanted.frame == "start" else stances[len(walk.falls)]
            walk.falls.append(Footfall(wanted, seen_from(seen, places[wanted.foot])))
        return "done" if controller.finished else None

    try:
        walk.reason = robot.run(controller, until=until, needs_imu=True).reason
    finally:
        walk.seconds = robot.loop.sim_time


def _places(robot: Robot, controller: FootprintWalker) -> Array:
    """Return the (2, 3) places of the feet: the truth of a twin, or what a robot believes."""
    twin, feet = robot.stack.twin, robot.description.feet
    if twin is None:
        return controller.places
    sites = [twin.model.site(foot.site).id for foot in feet]
    return ground_places(twin.data.site_xpos[sites], twin.data.site_xmat[sites])


def _named(place: Array) -> dict[str, float]:
    x, y, yaw = place.tolist()
    return {"x": x, "y": y, "yaw_deg": float(np.degrees(yaw))}
