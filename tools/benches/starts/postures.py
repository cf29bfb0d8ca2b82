"""Initial postures of a robot: joint positions, and orientation of the base."""

from dataclasses import dataclass
from typing import Literal, get_args

import mujoco
import numpy as np
from scipy.optimize import brentq, least_squares
from scipy.spatial.transform import Rotation

from windup.control.estimation.posture import PostureSense
from windup.control.kinematics.legs import legs_of
from windup.hal.joints import Array
from windup.robots import RobotDescription
from windup.tools.assembly.gaits import find_gait

Kind = Literal["standing", "squatting", "sitting", "lying", "hanging"]
KINDS: tuple[Kind, ...] = get_args(Kind)


def kinds_of(robot: RobotDescription) -> tuple[Kind, ...]:
    """Return the postures of a robot; one without a graph for sitting cannot sit."""
    return tuple(kind for kind in KINDS if kind != "sitting" or "sit" in robot.gaits())


JITTER = np.radians(4.0)
"""Standard deviation of a joint placed by hand, rad; that of a limp joint is twice as large."""
LEAN = 0.25
"""Largest tilt of a hanging robot, rad."""
SIDES = (("front", 0.35), ("back", 0.35), ("left", 0.15), ("right", 0.15))
QUARTER = np.pi / 2.0
TURNS: dict[str, tuple[str, float]] = {
    "front": ("y", QUARTER),
    "back": ("y", -QUARTER),
    "left": ("x", -QUARTER),
    "right": ("x", QUARTER),
}
"""Axis and angle by which an upright robot comes to lie, rad."""


@dataclass(frozen=True)
class StartPosture:
    """The initial state of a robot.

    Attributes:
        pose: (n,) joint positions, rad.
        turn: Orientation of the base.
        lift: Height of its lowest point above the floor, m.
        held: Whether it is held until its servos are driven; else it lies, limp.
        stays_held: Whether its base is held for ever.
    """

    pose: Array
    turn: Rotation
    lift: float = 0.0
    held: bool = True
    stays_held: bool = False


def random_posture(robot: RobotDescription, kind: Kind, rng: np.random.Generator) -> StartPosture:
    """Return a random posture of a robot, with a random heading."""
    joints = robot.joints
    jitter = JITTER * rng.normal(size=len(joints))
    around = Rotation.from_euler("z", float(rng.uniform(-np.pi, np.pi)))

    def inside(pose: Array) -> Array:
        return np.clip(pose, joints.lower, joints.upper)

    if kind in ("standing", "squatting"):
        low = robot.stance if robot.crouch is None else robot.crouch
        depth = float(rng.uniform(0.3, 1.0)) if kind == "squatting" else 0.0
        pose, level = on_feet(robot, robot.stance + depth * (low - robot.stance) + jitter)
        return StartPosture(inside(pose), around * level)
    if kind == "hanging":
        towards = float(rng.uniform(-np.pi, np.pi))
        angle = float(rng.uniform(0.0, LEAN))
        tilt = Rotation.from_rotvec([angle * np.cos(towards), angle * np.sin(towards), 0.0])
        pose = float(rng.uniform(0.0, 1.0)) * robot.stance + 2.0 * jitter
        return StartPosture(inside(pose), around * tilt, lift=0.2, stays_held=True)
    if kind == "sitting":
        pose = inside(np.asarray(find_gait(robot, "sit").graph.pose[-1]) + jitter)
        return StartPosture(pose, around * _leaning_back(robot, pose))
    side = str(rng.choice([name for name, _ in SIDES], p=[share for _, share in SIDES]))
    return StartPosture(
        inside(2.0 * jitter), around * Rotation.from_euler(*TURNS[side]), held=False
    )


def on_feet(robot: RobotDescription, pose: Array) -> tuple[Array, Rotation]:
    """Return a pose (n,) near `pose`, and a base orientation with flat soles under the CoM.

    The ankles are adjusted, as when a limp robot is put down by hand.
    """
    model = robot.model
    data = mujoco.MjData(model)
    base, sites = model.body(robot.base).id, [model.site(foot.site).id for foot in robot.feet]
    feet = [foot.body for foot in robot.feet]
    legs = legs_of(model, robot.base, feet, robot.joints, robot.stance)
    assert legs is not None, "soles of the robots that are tried are flat"
    ankles = _ankles(robot)

    def put(x: Array) -> Array:
        data.qpos[3:7] = _level(x).as_quat(scalar_first=True)
        data.qpos[7:] = pose
        data.qpos[7 + ankles] += x[2:]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        moved: Array = data.qpos[7:].copy()
        return moved

    def off(x: Array) -> Array:
        moved, frame = put(x), data.xmat[base].reshape(3, 3)
        tilts = (legs.soles(moved[None])[0][0] @ frame.T)[:, :2].ravel()
        soles = data.site_xpos[sites]
        weight = data.subtree_com[base] - soles.mean(axis=0)
        step = soles[:, 2] - soles[0, 2]
        return np.concatenate([tilts, 10.0 * step, 3.0 * weight[:2], 0.02 * x])

    best = least_squares(off, np.zeros(2 + len(ankles))).x
    return put(best), _level(best)


def _level(x: Array) -> Rotation:
    """Return the rotation about y and then about the new x by the first two of `x`, rad."""
    return Rotation.from_euler("YX", x[:2])


def _ankles(robot: RobotDescription) -> Array:
    """Return the indices of the joints that level the soles: ankles, and hip rolls if necessary."""
    names = robot.joints.names
    rolls = [row for row, name in enumerate(names) if name.endswith(("ank_roll", "ankle_roll"))]
    hips = [row for row, name in enumerate(names) if name.endswith("hip_roll")]
    pitches = [row for row, name in enumerate(names) if "_ank" in name and row not in rolls]
    return np.array(pitches + (rolls or hips))


def _leaning_back(robot: RobotDescription, pose: Array) -> Rotation:
    """Return the base orientation in which a robot sits on its seat and heels."""
    model = robot.model
    sense = PostureSense(model, [foot.body for foot in robot.feet])

    def seat(lean: float) -> float:
        """Return the height of the seat above the heels, m."""
        feet, others = sense.lowest(pose, np.array([np.sin(lean), 0.0, np.cos(lean)]))
        return others - feet

    return Rotation.from_euler("y", -float(brentq(seat, 0.0, 1.2)))
