"""A bus as used by the guardian: opened when needed, retried, and switched off."""

from contextlib import suppress

import numpy as np

from windup.hal.bus.bus import Bus
from windup.hal.error_text import error_text
from windup.hal.errors import HardwareError
from windup.hal.families import family_of, servo_model
from windup.hal.guardian.order import GuardedBus
from windup.hal.joints import Array, Mask
from windup.hal.port.open_port import open_port
from windup.hal.servo_bus.bus_readout import BusReadout
from windup.hal.servo_bus.servo_torque import ServoTorque
from windup.hal.servos.servo_model import ServoMount

UNLIMITED = (np.inf, -np.inf)
"""Levels (temperature, supply) of a servo without an entry in `GuardedBus.levels`."""


class RemoteBus:
    """The servos of one bus whose host has died.

    The port is opened only when needed: an adapter may be replugged, and the port is not busy for
    other programs before that.

    Args:
        record: The bus and its servos.

    Attributes:
        trouble: Why the last attempt to switch off failed; "" before any.
    """

    def __init__(self, record: GuardedBus) -> None:
        self.record = record
        self.trouble = ""
        self._mounts = [
            _mount(id, name, id in record.extended) for id, name in record.servos.items()
        ]
        self._torque: ServoTorque | None = None

    def torque(self) -> ServoTorque:
        """Return the torque control of the servos; opens the port if it is not open.

        Raises:
            HardwareError: The port cannot be opened.
        """
        if self._torque is None:
            # Not exclusive: a child of the dead host may still have the port open.
            port = open_port(self.record.url, self.record.baud, exclusive=False)
            port.latency = max(port.latency, self.record.latency)
            port.echoes = self.record.echoes
            bus = Bus(port, family_of(self._mounts[0].model.name))
            rows, known = range(len(self._mounts)), self.record.names
            names = [known[id] for id in self.record.servos] if known else ()
            readout = BusReadout(bus, self._mounts, rows, names=names)
            self._torque = ServoTorque(readout, 0.0)
        return self._torque

    def hold_position(self) -> Array:
        """Make the servos hold their present positions; return those (servos,), counts.

        Raises:
            HardwareError: A servo has no torque, or cannot be read.
        """
        return self.torque().hold_position()

    def send_goals(self, goals: Array) -> None:
        """Send goals (servos,), counts, if all servos have torque: a goal may switch torque on.

        Raises:
            HardwareError: A servo has lost its torque, or cannot be read.
        """
        torque = self.torque()
        if not torque.state().all_on:
            raise HardwareError(f"{self.record.url}: a servo lost its torque, or is silent")
        torque.readout.goals.values[:] = goals
        torque.readout.bus.exchange.send(torque.readout.goals.frames())

    def health_problem(self) -> str | None:
        """Return the servos whose temperature or supply requires torque off, as text, or None.

        Raises:
            HardwareError: The port is lost.
        """
        levels = [self.record.levels.get(id, UNLIMITED) for id in self.record.servos]
        hottest, lowest = np.transpose(levels)
        heat, supply = self._read("present_temperature"), self._read("present_voltage")
        for which, what in ((heat >= hottest, "too hot"), (supply <= lowest, "short of supply")):
            if which.any():
                verb = "is" if which.sum() == 1 else "are"
                return f"{self.record.url}: {self._names(which)} {verb} {what}"
        return None

    def _read(self, name: str) -> Array:
        """Return (servos,) values of a register in its unit; NaN if a servo does not answer."""
        bus = self.torque().readout.bus
        register = bus.family.registers[name]
        counts, valid = bus.sync_read(list(self.record.servos), register)
        return np.where(valid, counts * register.unit, np.nan)

    def switch_off(self) -> bool:
        """Switch torque off once, and return whether it is read back as off at all servos."""
        try:
            state = self.torque().off(attempts=1)
            if not state.all_off:
                verb = "is still on at" if state.on.any() else "cannot be read at"
                self.trouble = f"torque {verb} {self._names(~state.off)}"
                return False
        except Exception as error:  # after any error the other buses have to be switched off too
            self.trouble = error_text(error)
            self.close()
            return False
        self.close()
        return True

    def close(self) -> None:
        """Close the port."""
        torque, self._torque = self._torque, None
        if torque is not None:
            with suppress(Exception):
                torque.readout.bus.port.close()

    def _names(self, which: Mask) -> str:
        """Return the names of the servos `which` (servos,) bool, for messages."""
        return self.torque().readout.names_at(np.flatnonzero(which))


def _mount(id: int, name: str, extended: bool) -> ServoMount:
    model = servo_model(name)
    return ServoMount(model, "", id, 1, model.middle, 1.0, extended=extended)
