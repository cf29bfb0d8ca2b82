"""The protocol 1 error byte of an X servo, which has one bit for each kind of error.

The bits are those of the e-Manual's page on protocol 1. No manual states which of them an X sets
for what it refuses; the mapping here follows the bits' names. Voltage, heat and overload have the
same bits in Hardware Error Status(70).
"""

from collections.abc import Iterable
from typing import Final

from windup.sim_twin.wire.servos.health import INPUT_VOLTAGE, OVERHEATING, OVERLOAD
from windup.sim_twin.wire.servos.register_file import (
    BAD_ACCESS,
    BAD_CRC,
    BAD_INSTRUCTION,
    BAD_LENGTH,
    BAD_LIMIT,
    BAD_RANGE,
    FAILED,
    OK,
)

ANGLE_LIMIT, RANGE, CHECKSUM, INSTRUCTION = 0x02, 0x08, 0x10, 0x40
SHOWN: Final = INPUT_VOLTAGE | OVERHEATING | OVERLOAD
_BITS: Final = {
    OK: 0,
    FAILED: INSTRUCTION,
    BAD_INSTRUCTION: INSTRUCTION,
    BAD_CRC: CHECKSUM,
    **dict.fromkeys((BAD_RANGE, BAD_LENGTH, BAD_LIMIT, BAD_ACCESS), RANGE),
}


def protocol1_error(error: int, hardware: int, names: Iterable[str] = ()) -> int:
    """Return the error byte of protocol 1.

    Args:
        error: Error of protocol 2.
        hardware: Hardware Error Status.
        names: Registers that the instruction would have written.
    """
    refused = ANGLE_LIMIT if error == BAD_LIMIT and "goal_position" in names else _BITS[error]
    return hardware & SHOWN | refused
