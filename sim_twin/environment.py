"""Builds the simulation model: the robot's MJCF plus actuators, ground and plant deviations."""

from dataclasses import dataclass, field
from itertools import product

import mujoco

from windup.robots.completion import COM_VELOCITY
from windup.robots.description import RobotDescription
from windup.sim_twin.ground.terrain import Ground
from windup.sim_twin.masses import set_explicit_masses
from windup.sim_twin.plant import Plant
from windup.sim_twin.servo.servo_motor import add_actuators


@dataclass(frozen=True)
class Environment:
    """The ground around a twin, and how its robot deviates from the robot's files.

    Attributes:
        ground: The ground.
        plant: Deviations of the robot from its files.
        self_collision: Whether the two legs collide with each other.
    """

    ground: Ground = field(default_factory=Ground)
    plant: Plant = field(default_factory=Plant)
    self_collision: bool = False


def build_model(
    robot: RobotDescription,
    *,
    delay: float | None = None,
    supply: float | None = None,
    bare: bool = False,
    world: Environment | None = None,
) -> mujoco.MjModel:
    """Return the robot's model with actuators.

    Args:
        robot: The robot.
        delay: Latency from a write until the joint acts on it, s; by default the robot's own.
        supply: Supply voltage of the servos, V; by default the robot's own.
        bare: Leave out what a rollout does not need, as it ends with a fall.
        world: Ground, plant and self-collision; by default flat, nominal and none.
    """
    world = world or Environment()
    spec = robot.spec()
    set_explicit_masses(spec)
    world.plant.apply_to(spec)
    world.ground.build(spec)
    if world.self_collision:
        _part_legs(spec, robot)
    if bare:
        _strip(spec, robot)
    delay = robot.drive.command_delay if delay is None else delay
    add_actuators(spec, robot, delay, robot.drive.supply if supply is None else supply)
    # Without autoreset a twin that diverges raises an error and does not silently start again.
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    # One robot is one constraint island: searching for more costs a few percent of the time.
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ISLAND)
    # MuJoCo 4.0's sparse Cholesky has a bug above our problem size; dense is faster here anyway.
    spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    return spec.compile()


def _strip(spec: mujoco.MjSpec, robot: RobotDescription) -> None:
    """Keep only the geoms of feet and floor, and the contact and CoM velocity sensors.

    Other geoms touch the floor only after the robot has fallen, and a rollout ends with the fall.
    """
    feet = {foot.body for foot in robot.feet}
    for geom in list(spec.geoms):
        collides = geom.contype or geom.conaffinity
        if not collides or geom.parent.name not in {*feet, "world"}:
            spec.delete(geom)
    kept = {*robot.contacts.names, COM_VELOCITY}
    for sensor in list(spec.sensors):
        if sensor.name not in kept:
            spec.delete(sensor)


def _part_legs(spec: mujoco.MjSpec, robot: RobotDescription) -> None:
    """Let the left and right leg collide, with the largest geom of each body.

    The robots' geoms collide with the floor only (floor contype 1, conaffinity 0; robot 0 and 1),
    so the legs need explicit contact pairs.
    """
    left, right = (_leg(spec, robot, foot.body) for foot in robot.feet[:2])
    for one, other in product(left, right):
        spec.add_pair(geomname1=one, geomname2=other, condim=3)


def _leg(spec: mujoco.MjSpec, robot: RobotDescription, foot: str) -> list[str]:
    """Return the names of the largest geoms of the bodies from `foot` up to the base."""
    names = []
    body = spec.body(foot)
    while body.name != robot.base:
        solid = [geom for geom in body.geoms if geom.type != mujoco.mjtGeom.mjGEOM_PLANE]
        if solid:
            geom = max(solid, key=lambda geom: float(max(geom.size)))
            geom.name = geom.name or f"{body.name}_hull"
            names.append(geom.name)
        body = body.parent
    return names
