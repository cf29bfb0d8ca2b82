"""One start of an emulated robot: place it in a posture, and run the motion that fits."""

import tempfile
from contextlib import ExitStack, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from windup.hal.errors import FirstMotionError, PostureError, WindupError
from windup.hal.observation import Observation
from windup.robots import load_robot
from windup.sim_twin.lowest import lowest_point
from windup.sim_twin.twin import Twin
from windup.sim_twin.wire.shafts.twin_shaft import TwinPhysics
from windup.sim_twin.wire.world.bus_world import BusWorld
from windup.tools.behaviours.rise import rise
from windup.tools.benches.starts.faults import Fault, FaultyJoints
from windup.tools.benches.starts.postures import KINDS, Kind, StartPosture, random_posture
from windup.tools.robot.robot import Robot
from windup.tools.testing.servo_bus import ServoBus

SETTLE_TIME = 2.0
"""Time for limp limbs to come to rest, s."""
STAND = 1.0
"""Duration of standing, s."""
CLOSE = np.radians(8.0)
"""Largest deviation of a standing robot from its stance, rad: loads hold joints back."""
MAX_FAULT_MOTION = 15.0
"""Largest allowed motion of a joint with a fault, degrees."""
JAM_ANGLE = np.radians(10.0)
"""Smallest commanded motion that reveals a jammed joint, rad."""


@dataclass(frozen=True)
class Start:
    """Description of a start.

    Attributes:
        robot: Name of the robot.
        kind: Its posture.
        seed: Seed of all random numbers.
        fault: Its fault, or None.
    """

    robot: str
    kind: Kind
    seed: int
    fault: Fault | None = None

    def generator(self) -> np.random.Generator:
        """Return the random number generator of this start."""
        return np.random.default_rng([self.seed, KINDS.index(self.kind)])


def try_start(start: Start) -> dict[str, Any]:
    """Return the result of a start.

    "outcome" is "done", "refused" (unsuitable posture), "first motion" (a joint did not follow),
    "fell", or another error; "said" is the message; "told" whether a robot that lies or sits
    was refused before torque came on; "moved" the largest motion of joints with a fault, degrees;
    "harm" whether a fault had an effect for which it should have been caught.
    """
    truth, rng = load_robot(start.robot), start.generator()
    placed = random_posture(truth, start.kind, rng)
    broken = None if start.fault is None else FaultyJoints.random(truth, start.fault, rng)
    row: dict[str, Any] = {**asdict(start), "joints": [], "moved": 0.0, "told": None}
    with ExitStack() as stack:
        bus = stack.enter_context(ServoBus(start.robot, seed=start.seed))
        name = start.robot
        if broken is not None:
            folder = stack.enter_context(tempfile.TemporaryDirectory())
            name = str(broken.folder(truth, Path(folder)))
            row["joints"] = [truth.joints.names[joint] for joint in broken.joints]
        robot = Robot.open(name, port=bus.url)
        stack.callback(_close, robot)
        _place(robot, bus.world, placed)
        if broken is not None:
            _break(bus.world, broken)
        moved = _Moved(robot.twin, [] if broken is None else list(broken.joints))
        robot.watch.append(moved.update)
        row |= _run(robot, start.kind)
        row["moved"] = moved.most
        if broken is not None:
            row["harm"] = _does_harm(robot, broken, placed, row)
    return row


def _does_harm(
    robot: Robot, broken: FaultyJoints, placed: StartPosture, row: dict[str, Any]
) -> bool:
    """Return whether a fault had an effect: a fall, a large motion, a joint that did not move."""
    way = np.abs(robot.description.stance - placed.pose)[list(broken.joints)].max()
    if broken.fault == "jam":
        return bool(row["outcome"] != "done" or way > JAM_ANGLE)
    return bool(row["outcome"] != "done" or row["moved"] > MAX_FAULT_MOTION)


@dataclass
class _Moved:
    """Measures the largest motion of some joints of a twin.

    Attributes:
        most: Largest motion so far, degrees.
    """

    twin: Twin
    joints: list[int]
    most: float = 0.0

    def __post_init__(self) -> None:
        self._from = self.twin.data.qpos[7:].copy()

    def update(self, observation: Observation) -> None:
        if self.joints:
            away = np.abs(self.twin.data.qpos[7:] - self._from)[self.joints]
            self.most = max(self.most, float(np.degrees(away.max())))


def _close(robot: Robot) -> None:
    """Close the robot; a jammed joint may stop the closing crouch, too, and torque is off then."""
    with suppress(WindupError):
        robot.close()


def _place(robot: Robot, world: BusWorld, placed: StartPosture) -> None:
    """Place the twin in a posture, and let limp limbs come to rest and sensors settle."""
    physics, twin = world.physics, robot.twin
    assert isinstance(physics, TwinPhysics)
    twin.reset(placed.pose)
    twin.data.qpos[:2], twin.data.qpos[3:7] = 0.0, placed.turn.as_quat(scalar_first=True)
    mujoco.mj_forward(twin.model, twin.data)
    twin.data.qpos[2] += placed.lift - lowest_point(twin.model, twin.data)
    mujoco.mj_forward(twin.model, twin.data)
    physics.held, physics.stays_held = placed.held, placed.stays_held
    physics.store_held_pose()
    clock = robot.backend.clock
    clock.wait_until(clock.now() + SETTLE_TIME)


def _break(world: BusWorld, broken: FaultyJoints) -> None:
    """Jam a joint, or invert a motor; faults in the file need no change of the world."""
    physics = world.physics
    assert isinstance(physics, TwinPhysics)
    if broken.fault == "jam":
        physics.store_held_pose()
        physics.jammed[list(broken.joints)] = True
    if broken.fault == "motor":
        for shaft in physics.shafts:
            shaft.miswired = shaft.joint in broken.joints


def _run(robot: Robot, kind: Kind) -> dict[str, Any]:
    """Run the motion that fits the posture, and return its result.

    A robot that lies or sits is asked to stand first. If that is refused, it gets up if it can.
    """
    row: dict[str, Any] = {}
    try:
        return row | _stand(robot)
    except PostureError as error:
        row |= {"outcome": "refused", "said": str(error)}
    if kind in ("sitting", "lying") and not robot.armed:
        row["told"] = True
        if "get_up_front" in robot.description.gaits():
            row |= _rise(robot)
    return row


def _stand(robot: Robot) -> dict[str, Any]:
    """Stand, and return the result.

    Raises:
        PostureError: It was refused.
    """
    try:
        reason = robot.stand(STAND).reason
    except FirstMotionError as error:
        return {"outcome": "first motion", "said": str(error)}
    except PostureError:
        raise
    except WindupError as error:
        return {"outcome": type(error).__name__, "said": str(error)}
    away = float(np.abs(robot.backend.read().joints.position - robot.description.stance).max())
    if reason == "done" and away > CLOSE:
        return {"outcome": "away", "said": f"{np.degrees(away):.0f} degrees from its stance"}
    return {"outcome": reason if reason in ("done", "fell") else "ended", "said": reason}


def _rise(robot: Robot) -> dict[str, Any]:
    """Get up, and return the result."""
    report: dict[str, Any] = {"sides": [], "peak_load": 0.0, "up": False, "reason": ""}
    try:
        rise(robot, 3, report)
    except FirstMotionError as error:
        return {"outcome": "first motion", "said": str(error)}
    except WindupError as error:
        return {"outcome": type(error).__name__, "said": str(error)}
    return {"outcome": "done" if report["up"] else "fell", "said": report["reason"]}
