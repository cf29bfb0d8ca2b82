"""The IMU that a robot.toml names: its kind, and how it is mounted in this robot."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from windup.hal.errors import ConfigError, UnknownNameError
from windup.hal.imu.catalogue import imu_kind, usual_kind
from windup.hal.imu.kind import ImuKind
from windup.robots.mistake import Mistake
from windup.robots.records import Bus, Imu


def imu_of(imu: Imu | None, buses: Sequence[Bus]) -> ImuKind | None:
    """Return the kind of an IMU, with the axes that robot.toml gives it.

    Raises:
        UnknownNameError: There is no such kind.
    """
    if imu is None:
        return None
    if imu.kind is None:
        kind = usual_kind(buses[0].protocol if buses else None)
    else:
        kind = imu_kind(imu.kind)
    return kind if imu.mounting is None else replace(kind, axes=imu.mounting)


def kind_mistakes(imu: Imu, buses: Sequence[Bus]) -> Iterator[Mistake]:
    """Yield key and mistake of the kind and the mounting of an [imu]."""
    try:
        kind = imu_of(imu, buses)
    except UnknownNameError as error:
        yield "imu.kind", str(error)
        return
    if imu.kind is not None and kind is not None and kind.wiring == "board":
        first = buses[0] if buses else None
        if first is not None and first.protocol != "dynamixel2":
            speaks = f'bus {first.name!r} has protocol "{first.protocol}"'
            yield "imu.kind", f'an {kind.name} is read by protocol "dynamixel2", and {speaks}'
    try:
        _ = kind.mounting if kind is not None else None
    except ConfigError as error:
        yield "imu.mounting", str(error)
