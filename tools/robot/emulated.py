"""The worlds behind twin:// ports: private to one robot, or named and shared."""

from itertools import count
from pathlib import Path

import windup.sim_twin.wire as wire
from windup.hal.errors import UsageError
from windup.robots import RobotDescription
from windup.sim_twin.environment import Environment
from windup.sim_twin.twin import Twin
from windup.sim_twin.wire.shafts.twin_shaft import TwinPhysics

_worlds = count()


def in_a_world(
    robot: RobotDescription, port: str, around: Environment | None = None
) -> tuple[str, str]:
    """Return a twin:// URL that names its world, and the name if it is ours to forget.

    Raises:
        UsageError: It names another robot, or a world that has its ground and plant already.
    """
    address = wire.parse_address(port)
    if address.robot != robot.name and Path(address.robot).resolve() != robot.folder.resolve():
        raise UsageError(f"the port is a twin of {address.robot!r}, the robot is {robot.name!r}")
    if address.world and around is not None:
        raise UsageError(f"world {address.world!r} may be others' too; leave world= away")
    if address.world:
        return port, address.world
    name = f"{robot.name}-{next(_worlds)}"
    if around is not None:
        wire.put_world(name, wire.build_world(address, around), address.clock)
    return f"{port}{'&' if '?' in port else '?'}world={name}", name


def forget_world(world: str, port: str) -> None:
    """Forget a world that was made for `port`, which names none of its own."""
    if world and not wire.parse_address(port).world:
        wire.drop_world(world)


def twin_behind(world: str) -> Twin | None:
    """Return the twin of a world, or None where its servos turn each on their own."""
    owned = wire.find_world(world).owned
    return next((item for item in owned if isinstance(item, Twin)), None)


def begin_noisily(world: str, twin: Twin, noise: float, seed: int) -> None:
    """Put the twin of a world into its stance, with noise.

    Args:
        world: Name of its world.
        twin: The twin.
        noise: Standard deviation of the noise, degrees; it stays where hands hold it.
        seed: Seed of the noise.
    """
    twin.reset(noise=noise, seed=seed)
    physics = wire.find_world(world).physics
    if noise and isinstance(physics, TwinPhysics):
        physics.grasp()  # hands would put it back to where they took it
