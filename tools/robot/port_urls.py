"""The URLs of the buses of a robot, and of its IMU, from the value of --port."""

import windup.sim_twin.wire as wire
from windup.hal.errors import UsageError
from windup.hal.imu.kind import ImuKind
from windup.robots import RobotDescription

TWIN = "twin://"
IMU = "imu"
"""Name of the port of an IMU that is on no servo bus."""


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
