"""How the servos of one family are emulated: its devices, and the protocol of their bus."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Protocol

from windup.hal.servos.servo_model import ServoModel
from windup.sim_twin.wire.bus.bus import WireProtocol
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.shafts.shaft import Shaft


class ServoFactory(Protocol):
    """Makes the emulated servo of a data sheet."""

    def __call__(
        self,
        model: ServoModel,
        shaft: Shaft,
        identifier: int,
        baud: int,
        supply: float,
        return_delay: int,
        /,
    ) -> Device:
        """Return a new servo.

        Args:
            model: Its data sheet.
            shaft: The shaft that it drives.
            identifier: Bus id.
            baud: Baud rate.
            supply: Supply voltage, V.
            return_delay: Value of its return delay register; -1: the factory default.
        """
        ...


@dataclass(frozen=True)
class Emulation:
    """How the servos of one family are emulated.

    Attributes:
        servo: Makes a servo.
        protocol: Makes the protocol of a bus.
        bauds: Baud rates of the servos; empty: those of the driver's family.
    """

    servo: ServoFactory
    protocol: Callable[[], WireProtocol]
    bauds: Collection[int] = ()
