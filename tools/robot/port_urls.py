"""The ports of a robot: URLs of its buses and its IMU, and the emulated worlds behind twin://."""

from itertools import count
from pathlib import Path

import windup.sim_twin.wire as wire
from windup.hal.errors import UsageError
from windup.hal.imu.kind import ImuKind
from windup.robots import RobotDescription
from windup.sim_twin.environment import Environment
from windup.sim_twin.twin import Twin
from windup.sim_twin.wire.shafts.twin_shaft import TwinPhysics

_worlds = count()

TWIN = "twin://"
IMU = "imu"
"""Name of the port of an IMU that is on no servo bus."""


NOT_ARMED = "this moves a robot: give --arm (arm=True), and hold on to it"
"""What is said where torque is needed on a port that is no twin, and was not allowed."""


def check_port(robot: RobotDescription, port: str) -> None:
    """Raise what is wrong with a port of `robot`, before it is opened.

    Raises:
        UsageError: It does not fit the robot, or a number in a twin:// URL cannot be.
    """
    if any(servo is None for servo in robot.servos):
        raise UsageError(f"{robot.name} has no servos on a wire; leave --port away")
    for url in port_urls(robot, port).values():
        if url.startswith(TWIN):
            wire.parse_address(url)


def port_urls(robot: RobotDescription, port: str) -> dict[str, str]:
    """Return the URL of each bus, and of the IMU where it has a connection of its own.

    Raises:
        UsageError: The robot has no bus, a bus has no URL, or a name is no bus of the robot
            and not that of an IMU with a connection of its own.
    """
    names = [bus.name for bus in robot.buses]
    if not names:
        raise UsageError(f"{robot.name} has no servos on a bus; leave --port away for its twin")
    apart = has_own_connection(robot.imu_kind)
    first, equals, _ = port.partition("=")
    if equals and (first in names or (apart and first == IMU)):
        given = dict(part.partition("=")[::2] for part in port.split(","))
        if set(given) - ({IMU} if apart else set()) != set(names):
            raise UsageError(f"--port names {', '.join(given)}; the buses are {', '.join(names)}")
        return given
    if equals and first.isidentifier():
        wanted = " or ".join(f"--port {name}=URL" for name in names)
        raise UsageError(f"{robot.name} has no bus {first!r}; give {wanted}")
    if port.startswith(TWIN):
        also = [*names, IMU] if apart else names
        if len(also) == 1:
            return {names[0]: port}
        return {name: f"{port}{'&' if '?' in port else '?'}bus={name}" for name in also}
    if len(names) > 1:
        wanted = ",".join(f"{name}=URL" for name in names)
        raise UsageError(f"{robot.name} has several buses; give --port {wanted}")
    return {names[0]: port}


def has_own_connection(kind: ImuKind | None) -> bool:
    """Return whether an IMU has a connection of its own, beside the servo buses."""
    return kind is not None and kind.wiring != "board"


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
        wire.register_world(name, wire.build_world(address, around), address.clock)
    return f"{port}{'&' if '?' in port else '?'}world={name}", name


def forget_world(world: str, port: str) -> None:
    """Forget a world that was made for `port`, which names none of its own."""
    if world and not wire.parse_address(port).world:
        wire.unregister_world(world)


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
        physics.store_held_pose()  # hands would put it back to where they took it
