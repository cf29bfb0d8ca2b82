"""Homing of Feetech STS servos: sets the homing offset so that the present position is 2048."""

from windup.hal.bus.bus import Bus
from windup.hal.errors import HardwareError, UsageError
from windup.hal.servos.feetech_registers import MIDDLE

CENTRE = 2048
TOLERANCE = 8
"""Tolerated movement of the free shaft during the calibration, counts."""


def set_middle(bus: Bus, id: int) -> int:
    """Make the present position of servo `id` read 2048 permanently; nothing moves.

    Returns the homing offset that the servo has stored in its register 31, counts.

    Raises:
        UsageError: It is not an STS; an SCS has no homing offset.
        HardwareError: Its torque is on, or it does not read 2048 afterwards.
    """
    registers = bus.family.registers
    if "homing_offset" not in registers or "lock" not in registers:
        raise UsageError(
            f"a {bus.family.name} servo has no homing offset; set `zero` of its joint in robot.toml"
        )
    if bus.read(id, registers["torque_enable"]) != 0:
        raise HardwareError(
            f"id {id} on {bus.port.url}: torque is on; switch it off with `windup stop` first"
        )
    bus.command(id, registers["torque_enable"], MIDDLE, unlock=True)
    position = bus.read(id, registers["present_position"])
    if abs(position - CENTRE) > TOLERANCE:
        raise HardwareError(
            f"id {id} on {bus.port.url} reads {position} after its middle was set, "
            f"not {CENTRE}; hold it still and try again"
        )
    return bus.read(id, registers["homing_offset"])
