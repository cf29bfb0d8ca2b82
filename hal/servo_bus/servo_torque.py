"""Torque enable at the present pose, torque off with read-back, and the servos' Bus Watchdog."""

from shlex import quote

import numpy as np

from windup.hal.errors import HardwareError
from windup.hal.joints import Array
from windup.hal.registers import Register
from windup.hal.servo_bus.bus_readout import BusReadout, Rows
from windup.hal.servo_bus.bus_registers import ATTEMPTS, BusRegisters
from windup.hal.servo_bus.plausibility import MARGIN
from windup.hal.servo_bus.torque_cause import Suspect, find_torque_losses
from windup.hal.torque_loss import SWITCHED_OFF, UNEXPLAINED
from windup.hal.torque_state import TorqueState

TRIPPED = -1
"""Value of the Bus Watchdog register after it has fired.

In position mode the servo then holds its position, and rejects goals until the register is set to
0: the pose is frozen, but torque is not off.
"""
INRUSH = 5e-3
"""Pause after torque enable of each servo, s: all at once may pull the supply down."""
OFF_TIME = 0.12
"""Time after which `off` makes no further attempt, s."""


class ServoTorque:
    """Torque control of the servos of one bus, and of their Bus Watchdog, if they have one.

    Attributes:
        watchdog: Bus silence after which a servo freezes its pose, with torque on, s; 0 for none.
        armed: Whether the Bus Watchdog is running.
        powered: Whether torque has been switched on.
    """

    def __init__(self, readout: BusReadout, watchdog: float) -> None:
        self.readout, self.watchdog = readout, watchdog
        self.armed = self.powered = False
        self._registers = readout.bus.family.registers
        self._values = BusRegisters(readout)
        self._watch = self._registers.get("bus_watchdog")
        self._first = np.array([mount.first_count for mount in readout.mounts], dtype=np.float64)
        self._last = np.array([mount.last_count for mount in readout.mounts], dtype=np.float64)

    def on(self, gains: Array) -> TorqueState:
        """Switch torque on at the present pose, one servo after the other.

        The goal of each is set to its present position before torque enable, so nothing moves.

        Args:
            gains: (servos,) P registers.

        Raises:
            HardwareError: A servo cannot be read, does not accept its goal, or its torque does not
                come on or stay on; other servos may have torque.
        """
        self._prepare(gains)
        self.powered = True
        for row in range(len(self.readout.ids)):
            self._switch_on(row)
        state = self.state()
        if state.unknown.any():
            silent = self.readout.names_at(np.flatnonzero(state.unknown))
            raise HardwareError(f"{self.readout.bus.port.url}: no answer from {silent}")
        if state.off.any():
            raise HardwareError(self._off_again(int(np.argmax(state.off)), "stay"))
        return state

    def _prepare(self, gains: Array) -> None:
        """Write watchdog, restart mark, gains and goals, before torque enable."""
        here = self._present_positions()
        mark = self.readout.bus.family.restart_mark
        if self._watch is not None:
            self._values.set(self._watch, np.zeros_like(here))
        if mark is not None and mark.armed is not None:
            self._values.set(self._registers[mark.name], np.full_like(here, mark.armed))
        for gain, rows, _ in self.readout.gains:
            self._values.set(gain.register, gain.counts(gains[rows]), rows)
        if not self.readout.bus.family.goal_enables_torque:
            self._values.set(self._registers["goal_position"], here)
        if self._watch is not None and self.watchdog > 0.0:
            self._values.set(self._watch, np.full_like(here, self._ticks(self._watch)))
            self.armed = True

    def _switch_on(self, row: int) -> None:
        """Switch one servo on at its present position; writing the goal may switch it on."""
        enable, rows = self._registers["torque_enable"], slice(row, row + 1)
        self._values.set(self._registers["goal_position"], self._present_positions(rows), rows)
        for attempt in range(ATTEMPTS):
            self._values.pause(attempt)
            self._values.write(enable, 1, rows)
            if self._values.ask_torque(rows)[0].all():
                self.readout.bus.wait(INRUSH)
                return
        raise HardwareError(self._off_again(row, "come"))

    def _off_again(self, row: int, verb: str) -> str:
        """Return the message that a servo's torque does not `verb` on, with the cause if known."""
        url, id = self.readout.bus.port.url, self.readout.ids[row]
        what = f"{url}: torque does not {verb} on at {self.readout.names_at([row])}"
        loss = find_torque_losses(self.readout, [Suspect(id, False)], self.armed).get(id)
        if loss is None or loss in (SWITCHED_OFF, UNEXPLAINED):
            return f"{what}; run `windup scan {quote(url)}`"
        return f"{what}: {loss}; {loss.remedy}"

    def send_off(self) -> None:
        """Send torque off to all servos, without waiting or reading back."""
        self._values.write(self._registers["torque_enable"], 0)

    def off(self, attempts: int = ATTEMPTS) -> TorqueState:
        """Switch torque off and return the state that was read back.

        Servos that answer are off and read back within 0.12 s, even if others are silent.
        """
        self.send_off()
        clock = self.readout.bus.port.clock
        until = clock.now() + OFF_TIME
        state = TorqueState.unread(len(self.readout.ids))
        for attempt in range(attempts):
            state = self.retry_off(state, attempt)
            if state.all_off or clock.now() >= until:
                break
        self.armed = self.powered = False
        if self._watch is not None:
            self._values.write(self._watch, 0)
        return state

    def retry_off(self, state: TorqueState, attempt: int = 0) -> TorqueState:
        """Switch off again the servos not read back as off, and return the updated state."""
        left = np.flatnonzero(~state.off)
        self._values.write(self._registers["torque_enable"], 0, left)
        return self._read_state(state, left, attempt)

    def _read_state(self, state: TorqueState, rows: Rows, attempt: int) -> TorqueState:
        """Read torque enable of the servos at `rows`, and return the updated `state`."""
        seen, fresh = self._values.ask_torque(rows, attempt)
        on, unknown = state.on.copy(), state.unknown.copy()
        on[rows] = np.where(fresh, seen, on[rows])
        unknown[rows] &= ~fresh
        return TorqueState(on, unknown)

    def hold_position(self) -> Array:
        """Hold the present positions, without Bus Watchdog; return them (servos,), counts.

        Raises:
            HardwareError: A servo has no torque, cannot be read, or does not accept its goal.
        """
        if not self.state().all_on:
            raise HardwareError(f"{self.readout.bus.port.url}: a servo has no torque, or is silent")
        if self._watch is not None:
            self._values.set(self._watch, np.zeros(len(self.readout.ids)))
        here = self._present_positions()
        self._values.set(self._registers["goal_position"], here)
        return here

    def state(self, attempts: int = ATTEMPTS) -> TorqueState:
        """Read and return the present torque state of the servos."""
        state = TorqueState.unread(len(self.readout.ids))
        for attempt in range(attempts):
            self._values.pause(attempt)
            state = self._read_state(state, np.flatnonzero(state.unknown), attempt)
            if not state.unknown.any():
                break
        return state

    def _present_positions(self, rows: Rows = slice(None)) -> Array:
        """Return present positions (rows,), counts; with a weak checksum two readings must agree.

        Raises:
            HardwareError: Two readings do not agree, or a servo does not answer.
        """
        register = self._registers["present_position"]
        first, last = self._first[rows], self._last[rows]
        here = self._values.read(register, rows)
        if not self.readout.bus.family.protocol.weak:
            return np.clip(here, first, last)
        for _ in range(ATTEMPTS):
            before, here = here, self._values.read(register, rows)
            if (np.abs(here - before) <= MARGIN * last).all():
                return np.clip(here, first, last)
        raise HardwareError(
            f"{self.readout.bus.port.url}: positions jump or are out of range; "
            "hold the robot still and check the wiring"
        )

    def clear_watchdogs(self) -> int:
        """Clear Bus Watchdogs that have fired, at the present pose; return their number.

        The servos hold their position meanwhile, and then accept goals again. Torque that a servo
        has switched off stays off until `on`.
        """
        register = self._watch
        if register is None:
            return 0
        counts, valid = self.readout.bus.sync_read(self.readout.ids, register)
        fired = valid & (counts == TRIPPED)
        if not fired.any():
            return 0
        ids = [id for id, has in zip(self.readout.ids, fired, strict=True) if has]
        bus = self.readout.bus
        bus.sync_write(register, dict.fromkeys(ids, 0))
        here, known = bus.sync_read(ids, self._registers["present_position"])
        here = np.clip(here, self._first[fired], self._last[fired])
        at = {id: int(h) for id, h, k in zip(ids, here, known, strict=True) if k}
        if at:
            bus.sync_write(self._registers["goal_position"], at)
        bus.sync_write(register, dict.fromkeys(ids, self._ticks(register)))
        return len(ids)

    def _ticks(self, register: Register) -> int:
        return min(127, max(1, round(self.watchdog / register.unit)))
