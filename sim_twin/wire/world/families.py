"""The protocols of the servo models, and the construction of servos and protocols."""

from typing import Final

from windup.hal.errors import UnknownNameError, UsageError
from windup.hal.servos import servo_model
from windup.sim_twin.wire.bus.bus import WireProtocol
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.protocols.dynamixel import Dynamixel
from windup.sim_twin.wire.protocols.protocol1 import DYNAMIXEL1, FEETECH, Protocol1
from windup.sim_twin.wire.servos import dynamixel1_tables, feetech_tables, x_series
from windup.sim_twin.wire.servos.dynamixel1_servo import Dynamixel1Servo
from windup.sim_twin.wire.servos.feetech_servo import FeetechServo
from windup.sim_twin.wire.servos.servo import Servo
from windup.sim_twin.wire.shafts.shaft import Shaft

PROTOCOLS: Final = {
    **dict.fromkeys(x_series.MODELS, "dynamixel2"),
    **dict.fromkeys(dynamixel1_tables.MODELS, "dynamixel1"),
    **dict.fromkeys(feetech_tables.MODELS, "feetech"),
}


def full_name(name: str) -> str:
    """Return the name of a model; a family's short name ("XL430") means its first model.

    >>> full_name("STS3215")
    'STS3215-7.4V'

    Raises:
        UnknownNameError: There is no such model.
    """
    for known in PROTOCOLS:
        if known == name or known.split("-")[0] == name:
            return known
    raise UnknownNameError("servo model", name, PROTOCOLS)


def make_protocol(protocol: str) -> WireProtocol:
    """Return a new protocol instance."""
    if protocol == "dynamixel2":
        return Dynamixel()
    return Protocol1(FEETECH if protocol == "feetech" else DYNAMIXEL1)


def make_servo(
    name: str,
    shaft: Shaft,
    identifier: int,
    baud: int,
    supply: float,
    return_delay: int = -1,
    protocol: str | None = None,
) -> Device:
    """Return a new servo.

    Args:
        name: Model name.
        shaft: The shaft that it drives.
        identifier: Bus id.
        baud: Baud rate.
        supply: Supply voltage, V.
        return_delay: Return delay, in units of 2 us; -1: the factory default.
        protocol: Protocol of its bus.

    Raises:
        UsageError: It does not support the protocol or the baud rate.
    """
    name = full_name(name)
    spoken = PROTOCOLS[name]
    if protocol not in (None, spoken):
        raise UsageError(f"servo {name} {identifier} uses protocol {spoken}, its bus {protocol}")
    sheet = servo_model(name)
    registers = {} if return_delay < 0 else {"return_delay_time": return_delay}
    try:
        if spoken == "dynamixel2":
            table = x_series.MODELS[name]
            return Servo(table, sheet, shaft, identifier, baud, supply, **registers)
        if spoken == "feetech":
            sts = feetech_tables.MODELS[name]
            return FeetechServo(sts, sheet, shaft, identifier, baud, supply, **registers)
        mx = dynamixel1_tables.MODELS[name]
        return Dynamixel1Servo(mx, sheet, shaft, identifier, baud, supply, **registers)
    except (KeyError, ValueError):
        raise UsageError(f"servo {name} {identifier} does not support {baud} baud") from None
