"""The emulations of Windup's own servo families."""

from functools import partial
from typing import Final

from windup.hal.servos.servo_model import ServoModel
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.protocols.dynamixel import Dynamixel
from windup.sim_twin.wire.protocols.protocol1 import DYNAMIXEL1, FEETECH, Protocol1
from windup.sim_twin.wire.servos import dynamixel1_tables, feetech_tables, x_series
from windup.sim_twin.wire.servos.dynamixel1_servo import Dynamixel1Servo
from windup.sim_twin.wire.servos.feetech_servo import FeetechServo
from windup.sim_twin.wire.servos.servo import Servo
from windup.sim_twin.wire.shafts.shaft import Shaft
from windup.sim_twin.wire.world.emulation import Emulation


def _x_series(
    model: ServoModel, shaft: Shaft, identifier: int, baud: int, supply: float, return_delay: int
) -> Device:
    table = x_series.MODELS[model.name]
    return Servo(table, model, shaft, identifier, baud, supply, **_registers(return_delay))


def _dynamixel1(
    model: ServoModel, shaft: Shaft, identifier: int, baud: int, supply: float, return_delay: int
) -> Device:
    table = dynamixel1_tables.MODELS[model.name]
    registers = _registers(return_delay)
    return Dynamixel1Servo(table, model, shaft, identifier, baud, supply, **registers)


def _feetech(
    model: ServoModel, shaft: Shaft, identifier: int, baud: int, supply: float, return_delay: int
) -> Device:
    table = feetech_tables.MODELS[model.name]
    return FeetechServo(table, model, shaft, identifier, baud, supply, **_registers(return_delay))


def _registers(return_delay: int) -> dict[str, int]:
    """Return the registers that differ from the factory defaults."""
    return {} if return_delay < 0 else {"return_delay_time": return_delay}


EMULATIONS: Final = {
    "dynamixel2": Emulation(_x_series, Dynamixel, x_series.BAUD_RATES),
    "dynamixel1": Emulation(_dynamixel1, partial(Protocol1, DYNAMIXEL1), dynamixel1_tables.BAUDS),
    "feetech": Emulation(_feetech, partial(Protocol1, FEETECH), feetech_tables.BAUDS),
}
"""The emulations by the names of the protocols."""
PROTOCOLS: Final = {
    **dict.fromkeys(x_series.MODELS, "dynamixel2"),
    **dict.fromkeys(dynamixel1_tables.MODELS, "dynamixel1"),
    **dict.fromkeys(feetech_tables.MODELS, "feetech"),
}
"""The names of the protocols by the emulated models."""
