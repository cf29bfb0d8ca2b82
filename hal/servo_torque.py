"""Torque on at the present pose, off and read back, and the servos' watch over their host."""

from collections.abc import Sequence

import numpy as np

from hal.errors import HardwareError
from hal.joints import Array
from hal.plausibility import MARGIN
from hal.registers import Register
from hal.servo_line import Rows, ServoLine
from hal.torque_state import TorqueState

ATTEMPTS = 5
HELD_BACK = 0.016
"""An adapter may hold answers back for so long, and those to all that is asked meanwhile, s."""
TRIPPED = -1
"""What a Bus Watchdog reads that has fired.

In position mode the servo holds the place where it was then, and refuses goals until the register
is set to 0: the pose is frozen, the torque is not off.
"""


class ServoTorque:
    """The torque switch of one line, and the Bus Watchdog where its servos have one.

    Attributes:
        watchdog: Silence after which a servo freezes its pose, with torque on, s; 0 for none.
        armed: Is the watchdog running?
        powered: Has torque been switched on?
    """

    def __init__(self, line: ServoLine, watchdog: float) -> None:
        self.line, self.watchdog = line, watchdog
        self.armed = self.powered = False
        self._registers = line.bus.family.registers
        self._watch = self._registers.get("bus_watchdog")
        self._last = np.array([mount.model.last_count for mount in line.mounts], dtype=np.float64)

    def on(self, gains: Array) -> TorqueState:
        """Switch torque on where the joints are now; their P registers are `gains`.

        The goal is the present position before the torque comes on, so that nothing moves.
        Returns what was read back of the servos.

        Raises:
            HardwareError: A servo cannot be read, or does not take its goal; no torque comes on.
        """
        here = np.clip(self._here(), 0, self._last)
        if self._watch is not None:
            self._set(self._watch, np.zeros_like(here))
        for gain, rows, _ in self.line.gains:
            self._set(gain.register, gain.counts(gains[rows]), rows)
        self.powered = True
        self._set(self._registers["goal_position"], here)
        if self._watch is not None and self.watchdog > 0.0:
            self._set(self._watch, np.full_like(here, self._ticks(self._watch)))
            self.armed = True
        return self._switch(True)

    def off(self, attempts: int = ATTEMPTS) -> TorqueState:
        """Switch torque off and return what was read back of the servos."""
        state = self._switch(False, attempts)
        self.armed = self.powered = False
        if self._watch is not None:
            self._write(self._watch, 0)
        return state

    def stay(self) -> Array:
        """Have the servos stay where they are, watching no host, and return (servos,) counts.

        Raises:
            HardwareError: A servo has no torque, cannot be read, or does not take its goal.
        """
        if not self.state().all_on:
            raise HardwareError(f"{self.line.bus.port.url}: a servo has no torque, or is silent")
        if self._watch is not None:
            self._set(self._watch, np.zeros(len(self.line.ids)))
        here: Array = np.clip(self._here(), 0, self._last)
        self._set(self._registers["goal_position"], here)
        return here

    def _here(self) -> Array:
        """Return (servos,) present positions; behind a weak checksum two readings must agree."""
        register = self._registers["present_position"]
        here = self._read_all(register)
        if not self.line.bus.family.dialect.weak:
            return here
        for _ in range(ATTEMPTS):
            before, here = here, self._read_all(register)
            if (np.abs(here - before) <= MARGIN * self._last).all():
                return here
        raise HardwareError(
            f"{self.line.bus.port.url}: positions that jump or cannot be; torque stays off; "
            "hold the robot still and check the wiring"
        )

    def _switch(self, on: bool, attempts: int = ATTEMPTS) -> TorqueState:
        """Write and read back until all servos obey; a lost frame is sent again."""
        for _ in range(attempts):
            self._write(self._registers["torque_enable"], int(on))
            state = self.state(attempts)
            if state.all_on if on else state.all_off:
                break
        return state

    def state(self, attempts: int = ATTEMPTS) -> TorqueState:
        """Return what can be read of the servos' torque now."""
        register = self._registers["torque_enable"]
        on = np.zeros(len(self.line.ids), dtype=bool)
        unread = np.ones_like(on)
        for _ in range(attempts):
            counts, valid = self.line.bus.sync_read(self.line.ids, register)
            on[valid & unread] = counts[valid & unread] != 0
            unread &= ~valid
            if not unread.any():
                break
        return TorqueState(on, unread)

    def revive(self) -> int:
        """Clear the watchdogs that have fired, at the present pose; return how many had.

        The servos hold all the while, and then take goals again. Torque that a servo has switched
        off stays off until `on`.
        """
        register = self._watch
        if register is None:
            return 0
        counts, valid = self.line.bus.sync_read(self.line.ids, register)
        fired = valid & (counts == TRIPPED)
        if not fired.any():
            return 0
        ids = [id for id, has in zip(self.line.ids, fired, strict=True) if has]
        bus = self.line.bus
        bus.sync_write(register, dict.fromkeys(ids, 0))
        here, known = bus.sync_read(ids, self._registers["present_position"])
        here = np.clip(here, 0, self._last[fired])
        at = {id: int(h) for id, h, k in zip(ids, here, known, strict=True) if k}
        if at:
            bus.sync_write(self._registers["goal_position"], at)
        bus.sync_write(register, dict.fromkeys(ids, self._ticks(register)))
        return len(ids)

    def _ticks(self, register: Register) -> int:
        return min(127, max(1, round(self.watchdog / register.unit)))

    def _write(self, register: Register, value: int) -> None:
        self.line.bus.sync_write(register, dict.fromkeys(self.line.ids, value))

    def _set(self, register: Register, values: Array, rows: Rows = slice(None)) -> None:
        """Write one register of the servos at `rows` and read it back.

        Raises:
            HardwareError: A servo keeps another value.
        """
        ids = np.array(self.line.ids)[rows].tolist()
        rounded = dict(zip(ids, np.rint(values).astype(int).tolist(), strict=True))
        for _ in range(ATTEMPTS):
            self.line.bus.sync_write(register, rounded)
            wrong = self._read_all(register, ids) != np.rint(values)
            if not wrong.any():
                return
        stubborn = ", ".join(str(ids[row]) for row in np.flatnonzero(wrong))
        raise HardwareError(
            f"{self.line.bus.port.url}: id {stubborn} does not take {register.name}; "
            "torque stays off"
        )

    def _read_all(self, register: Register, ids: Sequence[int] | None = None) -> Array:
        ids = self.line.ids if ids is None else ids
        for _ in range(ATTEMPTS):
            counts, valid = self.line.bus.sync_read(ids, register)
            if valid.all():
                return counts.astype(np.float64)
            clock = self.line.bus.port.clock
            clock.wait_until(clock.now() + HELD_BACK)
        missing = [id for id, has in zip(ids, valid, strict=True) if not has]
        url = self.line.bus.port.url
        raise HardwareError(
            f"{url}: no answer from id {', '.join(map(str, missing))}; torque stays off; "
            f"run `windup scan {url}`"
        )
