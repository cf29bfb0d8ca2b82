"""A bus as the guardian reaches it: opened when needed, again and again, and switched off."""

from contextlib import suppress

import numpy as np

from hal.bus import Bus
from hal.errors import HardwareError, UsageError
from hal.families import family_of
from hal.guardian.order import Charge
from hal.joints import Array, Mask
from hal.open_port import open_port
from hal.registers import Register
from hal.servo_line import ServoLine
from hal.servo_model import ServoMount
from hal.servo_torque import ServoTorque
from hal.servos import servo_model

MARGIN = 5.0
"""How far below its own limit a servo counts as too hot, degrees C."""


class RemoteBus:
    """The servos of one bus whose program is gone.

    No port is open before it is needed: an adapter may come and go, and nobody finds it busy.

    Args:
        charge: Which bus, and which servos.

    Attributes:
        trouble: Why the last attempt failed, "" before any.
    """

    def __init__(self, charge: Charge) -> None:
        self.charge = charge
        self.trouble = ""
        self._mounts = [_mount(id, name) for id, name in charge.servos.items()]
        self._torque: ServoTorque | None = None

    def torque(self) -> ServoTorque:
        """Return the torque switch of the servos; opens the port if it is not open.

        Raises:
            HardwareError: The port cannot be opened.
        """
        if self._torque is None:
            # A child of the dead host may still have it open.
            port = open_port(self.charge.url, self.charge.baud, exclusive=False)
            bus = Bus(port, family_of(self._mounts[0].model.name))
            line = ServoLine(bus, self._mounts, list(range(len(self._mounts))))
            self._torque = ServoTorque(line, 0.0)
        return self._torque

    def stay(self) -> Array:
        """Have the servos stay where they are and return (servos,) counts.

        Raises:
            HardwareError: A servo has no torque, or cannot be read.
        """
        return self.torque().stay()

    def send_goals(self, goals: Array) -> None:
        """Send (servos,) counts if all servos have torque: a goal may switch on one that has not.

        Raises:
            HardwareError: A servo has no torque any more, or cannot be read.
        """
        torque = self.torque()
        if not torque.state().all_on:
            raise HardwareError(f"{self.charge.url}: a servo lost its torque, or is silent")
        torque.line.goals.values[:] = goals
        torque.line.bus.exchange.send(torque.line.goals.frames())

    def complaint(self) -> str | None:
        """Return whose heat, supply or silence asks for the torque to go off, or None.

        The limits are the servos' own; heat counts from 5 degrees C below.

        Raises:
            HardwareError: The port is gone.
        """
        hot, _ = self._compare("present_temperature", "temperature_limit", MARGIN)
        _, low = self._compare("present_voltage", "min_voltage_limit", 0.0)
        for which, what in ((hot, "is too hot"), (low, "has too little supply")):
            if which.any():
                ids = [id for id, has in zip(self.charge.servos, which, strict=True) if has]
                return f"{self.charge.url}: id {', '.join(map(str, ids))} {what}"
        return None

    def _compare(self, name: str, limit: str, margin: float) -> tuple[Mask, Mask]:
        """Return (servos,) bool: whose register is above its limit register, and whose below."""
        bus = self.torque().line.bus
        value, bound = (self._read(bus.family.registers[each]) for each in (name, limit))
        return value >= bound - margin, value <= bound

    def _read(self, register: Register) -> Array:
        """Return (servos,) values of a register in its unit; not a number where nobody answers."""
        counts, valid = self.torque().line.bus.sync_read(list(self.charge.servos), register)
        return np.where(valid, counts * register.unit, np.nan)

    def switch_off(self) -> bool:
        """Switch torque off once, and return whether all of it has been read as off."""
        try:
            state = self.torque().off(attempts=1)
        except (HardwareError, UsageError) as error:
            self.trouble = str(error)
            self.close()
            return False
        if state.all_off:
            self.close()
            return True
        ids = [str(id) for id, off in zip(self.charge.servos, state.off, strict=True) if not off]
        verb = "is still on at" if state.on.any() else "cannot be read at"
        self.trouble = f"torque {verb} id {', '.join(ids)}"
        return False

    def close(self) -> None:
        """Give the port back."""
        if self._torque is not None:
            with suppress(HardwareError):
                self._torque.line.bus.port.close()
            self._torque = None


def _mount(id: int, name: str) -> ServoMount:
    model = servo_model(name)
    return ServoMount(model, "", id, 1, model.middle, 1.0)
