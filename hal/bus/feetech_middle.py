"""What only Feetech's STS servos can do: call the present position the middle."""

from windup.hal.bus.bus import Bus
from windup.hal.errors import HardwareError, UsageError
from windup.hal.servos.feetech_registers import MIDDLE

CENTRE = 2048
TOLERANCE = 8
"""Counts by which the shaft may move while nobody holds it."""


def set_middle(bus: Bus, id: int) -> int:
    """Make the present position of servo `id` count 2048, for good; nothing moves.

    Returns the offset, counts, that the servo has put into its register 31.

    Raises:
        UsageError: It is no STS; an SCS has no offset.
        HardwareError: Its torque is on, or it does not read 2048 afterwards.
    """
    registers = bus.family.registers
    if "homing_offset" not in registers or "lock" not in registers:
        raise UsageError(
            f"a {bus.family.name} servo cannot be told its middle; calibrate in a file"
        )
    if bus.read(id, registers["torque_enable"]) != 0:
        raise HardwareError(f"id {id} on {bus.port.url}: torque is on; `windup stop` first")
    bus.command(id, registers["torque_enable"], MIDDLE, unlock=True)
    position = bus.read(id, registers["present_position"])
    if abs(position - CENTRE) > TOLERANCE:
        raise HardwareError(
            f"id {id} on {bus.port.url} reads {position} after it was told its middle, "
            f"not {CENTRE}; hold it still and try again"
        )
    return bus.read(id, registers["homing_offset"])
