"""Reads the torque of the servos after a trial with the vendors' own SDKs."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import dynamixel_sdk
import scservo_sdk

from windup.robots import RobotDescription

TORQUE_X, WATCHDOG_X, TORQUE_STS = 64, 98, 40
TRIPPED = 255
ATTEMPTS = 5


def torque_of(robot: RobotDescription, port: str) -> dict[str, int | None]:
    """Return torque enable by joint name, as the vendor's SDK reads it; None without an answer.

    -1 stands for a Dynamixel whose bus watchdog has tripped.
    """
    bus = robot.buses[0]
    path = dict(part.split("=") for part in port.split(",")).get(bus.name) if "=" in port else port
    names = zip(robot.joints.names, robot.servos, strict=True)
    ids = {name: servo.id for name, servo in names if servo is not None}
    if bus.protocol == "dynamixel2":
        return _read_dynamixel(str(path), bus.baud, ids)
    return _read_feetech(str(path), bus.baud, ids)


def _read_dynamixel(path: str, baud: int, ids: dict[str, int]) -> dict[str, int | None]:
    found: dict[str, int | None] = {}
    with _opened(dynamixel_sdk.PortHandler(path), baud) as port:
        packets = dynamixel_sdk.PacketHandler(2.0)
        for name, id in ids.items():
            torque = _ask(packets, port, id, TORQUE_X)
            frozen = torque == 1 and _ask(packets, port, id, WATCHDOG_X) == TRIPPED
            found[name] = -1 if frozen else torque
    return found


def _read_feetech(path: str, baud: int, ids: dict[str, int]) -> dict[str, int | None]:
    with _opened(scservo_sdk.PortHandler(path), baud) as port:
        packets = scservo_sdk.PacketHandler(0)
        return {name: _ask(packets, port, id, TORQUE_STS) for name, id in ids.items()}


def _ask(packets: Any, port: Any, id: int, address: int) -> int | None:
    for _ in range(ATTEMPTS):
        value, result, _ = packets.read1ByteTxRx(port, id, address)
        if result == 0:
            return int(value)
    return None


@contextmanager
def _opened(port: Any, baud: int) -> Iterator[Any]:
    port.openPort()
    port.setBaudRate(baud)
    try:
        yield port
    finally:
        port.closePort()
