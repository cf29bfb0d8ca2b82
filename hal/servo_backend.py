"""Joints on buses of Dynamixel servos, behind the joint-command interface."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hal.backend import Clock
from hal.bus import Bus
from hal.clock import WallClock
from hal.command import JointCommand, shifted_goal
from hal.errors import HardwareError, UsageError
from hal.exchange import TURNAROUND
from hal.imu.opencr import POWER, POWER_UP_TIME, OpenCr
from hal.joints import Array, Joints, Mask
from hal.observation import ImuState, JointState, Observation
from hal.open_port import open_port
from hal.port import Port
from hal.servo_line import REGISTERS, ServoLine
from hal.servo_model import ServoMount
from hal.servo_settings import assert_settings
from hal.servo_torque import ServoTorque
from hal.servos.x_series_registers import HARDWARE_ERRORS, hardware_errors
from hal.units import Units
from hal.wiring import check_mounts, check_servos, row_groups

LARGEST_GAIN = 16383
ERROR_KINDS = ("no answer", "corrupt", "resynchronised", "watchdog")
ATTEMPTS = 5


@dataclass(frozen=True)
class BusPort:
    """Where a bus is plugged in: a URL for `open_port`, and its bits a second."""

    url: str
    baud: int


class ServoBackend:
    """The joints of one robot on k buses of Dynamixel X servos.

    The servos' law is that of `ServoModel`: stiffness becomes a P register, sent when it changes;
    velocity and torque become a shifted goal; damping is the motor's own. A joint that does not
    answer keeps its last state, with its age.

    Args:
        joints: The joints.
        mounts: The servo of each joint, in the same order.
        ports: Bus name to its port.
        supply: Voltage for which stiffness is turned into P registers, V.
        board: The OpenCR, read with the servos of its bus.
        watchdog: Silence after which the servos stop by themselves, s; 0 for none.
        contacts: Number of contact sensors that observations have room for; none is measured.
        opener: Opens a port.

    Attributes:
        alerts: Joint name to what its servo's hardware error register says.
        clamps: Clamp name to the number of commands it changed.
        watchdog_trips: Servos that had stopped for silence, and were cleared.
    """

    def __init__(
        self,
        joints: Joints,
        mounts: Sequence[ServoMount],
        ports: Mapping[str, BusPort],
        *,
        supply: float = 12.0,
        board: OpenCr | None = None,
        watchdog: float = 0.2,
        contacts: int = 0,
        opener: Callable[[str, int], Port] = open_port,
    ) -> None:
        self.joints, self.mounts, self.board = joints, tuple(mounts), board
        self.units = Units(self.mounts, supply)
        check_mounts(joints, self.mounts, ports, self.units)
        self._ports, self._opener, self._watchdog = dict(ports), opener, watchdog
        self.clock: Clock = WallClock()
        self.lines: list[ServoLine] = []
        self._torque: list[ServoTorque] = []
        self.alert_kinds = (*HARDWARE_ERRORS.values(), "unknown")
        self.alerts: dict[str, tuple[str, ...]] = {}
        self.clamps: Counter[str] = Counter({"goal": 0, "gain": 0})
        self.watchdog_trips = 0
        n = len(joints)
        self._counts = np.full((3, n), np.nan)
        self._health = np.full((2, n), np.nan)
        self._answered = np.full(n, -np.inf)
        self._alert: Mask = np.zeros(n, dtype=bool)
        self._imu_at = -np.inf
        self._patience = 0.9 * watchdog
        self._contacts = np.zeros(contacts)
        self._top = np.array([mount.model.counts_per_rev - 1 for mount in self.mounts])
        self._realised = np.empty((2, n))
        self._realised[1] = self.units.damping
        self._gains = b""

    def connect(self) -> None:
        """Open the ports. Nothing moves.

        Raises:
            PortError: One cannot be opened; the others are closed again.
            UsageError: Some ports live on the wall's time and some in a virtual world.
        """
        self.disconnect()
        groups = row_groups(self.mounts)
        try:
            for name, rows in groups.items():
                port = self._opener(self._ports[name].url, self._ports[name].baud)
                ids = [self.mounts[row].id for row in rows]
                board = self.board if self.board and self.board.bus == name else None
                self.lines.append(ServoLine(Bus(port), ids, rows, board))
        except BaseException:
            self.disconnect()
            raise
        self._torque = [ServoTorque(line, self._watchdog) for line in self.lines]
        clocks = [line.bus.port.clock for line in self.lines]
        self.clock = clocks[0]
        if any(clock is not clocks[0] and not _both_wall(clock, clocks[0]) for clock in clocks):
            self.disconnect()
            raise UsageError("the buses of one robot have to live in one world, on one clock")

    def configure(self) -> None:
        """Check every servo, then assert the settings that the stack relies on. Nothing moves.

        Raises:
            HardwareError: Something is not as wired; nothing has been written.
        """
        buses = {self.mounts[line.rows[0]].bus: line.bus for line in self.lines}
        self._power_up(buses)
        for bus, id, settings in check_servos(self.joints, self.mounts, buses, self.board):
            assert_settings(bus, id, settings)
        for line in self.lines:
            line.bus.exchange.turnaround = TURNAROUND
            line.probe_fast()
        for _ in range(ATTEMPTS):
            self.read()
            if np.isfinite(self._answered).all():
                break
        else:
            silent = ", ".join(np.array(self.joints.names)[np.isinf(self._answered)])
            raise HardwareError(f"no answer to cyclic reads from {silent}; run `windup scan`")
        self._first_health()

    def request(self) -> None:
        """Ask every joint for its state."""
        for line in self.lines:
            line.request()

    def collect(self) -> Observation:
        """Return the state last asked for."""
        late = False
        for line, torque in zip(self.lines, self._torque, strict=True):
            valid = line.collect(self._counts, self._health, self._alert)
            late |= self._note_answers(line, valid, torque.armed)
        if late:
            self.watchdog_trips += sum(torque.revive() for torque in self._torque)
        if self.alerts or self._alert.any():
            self._explain_alerts()
        return self._observe()

    def read(self) -> Observation:
        """Return the present state: `request` and `collect`."""
        self.request()
        return self.collect()

    def write(self, command: JointCommand) -> JointCommand:
        """Send a command and return what the servos make of it."""
        block = command.block
        if block[3].tobytes() != self._gains:
            self._send_gains(block[3])
        goal = shifted_goal(command) if block[1:3].any() else block[0]
        counts = np.rint(self.units.counts(goal))
        inside = np.minimum(np.maximum(counts, 0.0), self._top)
        if not np.array_equal(inside, counts):
            self.clamps["goal"] += 1
        for line in self.lines:
            line.goals.values[:] = inside[line.rows]
            line.bus.exchange.send([line.goals.frame()])
        real = np.zeros_like(block)
        real[0] = self.units.angle(inside)
        real[3:] = self._realised
        return JointCommand(real)

    def bus_errors(self) -> Mapping[str, int]:
        """Return kind of error to how often it has happened, over all buses."""
        counts = dict.fromkeys(ERROR_KINDS, 0)
        for line in self.lines:
            for kind in ERROR_KINDS[:-1]:
                counts[kind] += line.bus.exchange.errors[kind]
        counts["watchdog"] = self.watchdog_trips
        return counts

    def set_torque(self, on: bool) -> Mask:
        """Switch all torque, on at the present pose only; (n,) bool read back.

        A joint that does not answer counts as on.

        Raises:
            HardwareError: Torque on, and a servo cannot be read; all torque is off.
        """
        state: Mask = np.zeros(len(self.joints), dtype=bool)
        self._gains = b""
        if not on:
            for line, torque in zip(self.lines, self._torque, strict=True):
                state[line.rows] = torque.off()
            return state
        gains = self._registers(self.joints.stiffness)
        try:
            for line, torque in zip(self.lines, self._torque, strict=True):
                state[line.rows] = torque.on(gains[line.rows])
        except HardwareError:
            self.set_torque(False)
            raise
        return state

    def disconnect(self) -> None:
        """Close the ports. Torque that is on stays on until the servos' watchdog fires."""
        for line in self.lines:
            line.bus.port.close()
        self.lines, self._torque = [], []

    def _note_answers(self, line: ServoLine, valid: Mask, armed: bool) -> bool:
        """Date the answers that came; return whether a watchdog may have fired before them."""
        now = self.clock.now()
        rows = line.rows if valid.all() else line.rows[valid]
        silent = armed and rows.size > 0 and now - self._answered[rows].min() > self._patience
        self._answered[rows] = now
        if line.imu_fresh:
            self._imu_at = now
        return bool(silent)

    def _observe(self) -> Observation:
        now = self.clock.now()
        position, velocity, torque = self.units.si(self._counts)
        voltage, temperature = self._health.copy()
        age = now - self._answered
        state = JointState(position, velocity, torque, voltage, temperature, age)
        return Observation(now, state, self._imu(now), self._contacts, None)

    def _imu(self, now: float) -> ImuState | None:
        for line in self.lines:
            if line.board is not None and line.imu is not None:
                return line.board.decode(line.imu, now - self._imu_at)
        return None

    def _registers(self, stiffness: Array) -> Array:
        """Return whole P registers (n,) for `stiffness` (n,) N m/rad at the joints."""
        wanted = np.rint(stiffness / self.units.stiffness)
        inside = np.clip(wanted, 0.0, LARGEST_GAIN)
        if (inside != wanted).any():
            self.clamps["gain"] += 1
        return np.asarray(inside)

    def _send_gains(self, stiffness: Array) -> None:
        registers = self._registers(stiffness)
        for line in self.lines:
            line.gains.values[:] = registers[line.rows]
            line.bus.exchange.send([line.gains.frame()])
        self._realised[0] = registers * self.units.stiffness
        self._gains = stiffness.tobytes()

    def _power_up(self, buses: Mapping[str, Bus]) -> None:
        """Give the servos power where an OpenCR switches it."""
        if self.board is None:
            return
        bus = buses[self.board.bus]
        if bus.read(self.board.id, POWER) != 1:
            bus.write(self.board.id, POWER, 1)
            self.clock.wait_until(self.clock.now() + POWER_UP_TIME)

    def _first_health(self) -> None:
        """Fill in voltage and temperature of all joints; the cycle refreshes one at a time."""
        for line in self.lines:
            for row, name in enumerate(("present_voltage", "present_temperature")):
                counts, valid = line.bus.sync_read(line.ids, REGISTERS[name])
                self._health[row, line.rows[valid]] = counts[valid] * REGISTERS[name].unit

    def _explain_alerts(self) -> None:
        """Read the hardware error of the joints that newly signal one; forget the others."""
        known = {name for name in self.alerts if self._alert[self.joints.index(name)]}
        self.alerts = {name: self.alerts[name] for name in known}
        for line in self.lines:
            for id, row in zip(line.ids, line.rows.tolist(), strict=True):
                name = self.joints.names[row]
                if self._alert[row] and name not in known:
                    self.alerts[name] = _hardware_error(line.bus, id)


def _hardware_error(bus: Bus, id: int) -> tuple[str, ...]:
    try:
        bits = bus.read(id, REGISTERS["hardware_error"])
    except HardwareError:
        bits = 0
    return hardware_errors(bits) or ("unknown",)


def _both_wall(one: Clock, other: Clock) -> bool:
    return isinstance(one, WallClock) and isinstance(other, WallClock)
