"""Torque on at the present pose, off and read back, and the servos' watch over their host."""

import numpy as np

from hal.errors import HardwareError
from hal.joints import Array, Mask
from hal.registers import Register
from hal.servo_line import REGISTERS, ServoLine

ATTEMPTS = 5
LAST_COUNT = 4095
TRIPPED = -1
"""What a Bus Watchdog reads that has fired; goals are refused until it is set to 0."""


class ServoTorque:
    """The torque switch and the Bus Watchdog of one line.

    Attributes:
        watchdog: Silence after which a servo stops, s; 0 for none.
        armed: Is the watchdog running?
    """

    def __init__(self, line: ServoLine, watchdog: float) -> None:
        self.line, self.watchdog = line, watchdog
        self.armed = False

    def on(self, gains: Array) -> Mask:
        """Switch torque on where the joints are now; their P registers are `gains`.

        The goal is the present position before the torque comes on, so that nothing moves.
        Returns (servos,) bool, read back.

        Raises:
            HardwareError: A servo cannot be read, or does not take its goal; no torque comes on.
        """
        here = np.clip(self._read_all(REGISTERS["present_position"]), 0, LAST_COUNT)
        self._set(REGISTERS["bus_watchdog"], np.zeros_like(here))
        self._set(REGISTERS["position_p_gain"], gains)
        self._set(REGISTERS["goal_position"], here)
        if self.watchdog > 0.0:
            self._set(REGISTERS["bus_watchdog"], np.full_like(here, self._ticks()))
            self.armed = True
        return self._switch(True)

    def off(self) -> Mask:
        """Switch torque off and return (servos,) bool, read back."""
        state = self._switch(False)
        self.armed = False
        self._write(REGISTERS["bus_watchdog"], 0)
        return state

    def _switch(self, on: bool) -> Mask:
        """Write and read back until all servos obey; a lost frame is sent again."""
        for _ in range(ATTEMPTS):
            self._write(REGISTERS["torque_enable"], int(on))
            state = self.state()
            if (state == on).all():
                break
        return state

    def state(self) -> Mask:
        """Return (servos,) bool read back; a servo that does not answer counts as on."""
        register = REGISTERS["torque_enable"]
        on = np.ones(len(self.line.ids), dtype=bool)
        unread = on.copy()
        for _ in range(ATTEMPTS):
            counts, valid = self.line.bus.sync_read(self.line.ids, register)
            on[valid & unread] = counts[valid & unread] != 0
            unread &= ~valid
            if not unread.any():
                break
        return on

    def revive(self) -> int:
        """Clear the watchdogs that have fired, at the present pose; return how many had.

        Torque that a servo has switched off stays off until `on`.
        """
        register = REGISTERS["bus_watchdog"]
        counts, valid = self.line.bus.sync_read(self.line.ids, register)
        fired = valid & (counts == TRIPPED)
        if not fired.any():
            return 0
        ids = [id for id, has in zip(self.line.ids, fired, strict=True) if has]
        bus = self.line.bus
        bus.sync_write(register, dict.fromkeys(ids, 0))
        here, known = bus.sync_read(ids, REGISTERS["present_position"])
        here = np.clip(here, 0, LAST_COUNT)
        at = {id: int(h) for id, h, k in zip(ids, here, known, strict=True) if k}
        if at:
            bus.sync_write(REGISTERS["goal_position"], at)
        bus.sync_write(register, dict.fromkeys(ids, self._ticks()))
        return len(ids)

    def _ticks(self) -> int:
        return min(127, max(1, round(self.watchdog / REGISTERS["bus_watchdog"].unit)))

    def _write(self, register: Register, value: int) -> None:
        self.line.bus.sync_write(register, dict.fromkeys(self.line.ids, value))

    def _set(self, register: Register, values: Array) -> None:
        """Write one register of all servos and read it back.

        Raises:
            HardwareError: A servo keeps another value.
        """
        rounded = dict(zip(self.line.ids, np.rint(values).astype(int).tolist(), strict=True))
        for _ in range(ATTEMPTS):
            self.line.bus.sync_write(register, rounded)
            wrong = self._read_all(register) != np.rint(values)
            if not wrong.any():
                return
        stubborn = ", ".join(str(self.line.ids[row]) for row in np.flatnonzero(wrong))
        raise HardwareError(
            f"{self.line.bus.port.url}: id {stubborn} does not take {register.name}; "
            "torque stays off"
        )

    def _read_all(self, register: Register) -> Array:
        for _ in range(ATTEMPTS):
            counts, valid = self.line.bus.sync_read(self.line.ids, register)
            if valid.all():
                return counts.astype(np.float64)
        missing = [id for id, has in zip(self.line.ids, valid, strict=True) if not has]
        url = self.line.bus.port.url
        raise HardwareError(
            f"{url}: no answer from id {', '.join(map(str, missing))}; torque stays off; "
            f"run `windup scan {url}`"
        )
