"""Joints on buses of servos, of one make or of several, behind the joint-command interface."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from hal.backend import Clock
from hal.clock import WallClock
from hal.command import JointCommand, shifted_goal
from hal.coupling import Coupling, Couplings
from hal.errors import HardwareError, PortError
from hal.exchange import TURNAROUND
from hal.imu.opencr import OpenCr
from hal.imu.source import ImuSource
from hal.joints import Array, Joints, Mask
from hal.observation import ImuState, JointState, Observation
from hal.open_port import open_port
from hal.port import Port
from hal.servo_alerts import ServoAlerts, count_errors
from hal.servo_line import ServoLine
from hal.servo_link import BusPort, ImuLink, ServoLink
from hal.servo_model import ServoMount
from hal.servo_setup import lines_of, names_of, open_links, set_up
from hal.stop_button import StopButton
from hal.torque_state import TorqueState
from hal.units import Units
from hal.wiring import check_mounts

__all__ = ["BusPort", "ServoBackend"]

ATTEMPTS = 10


class ServoBackend:
    """The joints of one robot on k buses of servos, each bus of one family.

    The servos' law is that of `ServoModel`: stiffness becomes a P register, sent when it changes;
    velocity and torque become a shifted goal; damping is the motor's own. A joint that does not
    answer, or not believably, keeps its last state, with its age. So do the joints of a bus whose
    port has gone: it is opened again when it is back, with torque off, and no goal reaches it
    until `rearm`.

    Args:
        joints: The joints.
        mounts: The servo of each joint, in the same order.
        ports: Bus name to its port.
        supply: Voltage for which stiffness is turned into P registers, V.
        board: The OpenCR, read with the servos of its bus.
        imu: An IMU on a port of its own.
        couplings: Joints that two servos move together.
        watchdog: Silence after which a bus watchdog freezes the pose, torque on, s; 0 for none.
        contacts: Number of contact sensors that observations have room for; none is measured.
        opener: Opens a port.

    Attributes:
        links: The buses, from `connect` to `disconnect`.
        clamps: Clamp name to the number of commands it changed; "unarmed" are goals withheld.
        button: The buttons of the OpenCR: any of them is a stop.
        watchdog_trips: Servos that had frozen for silence, and were cleared.
        arming_stiffness: (n,) N m/rad with which torque comes on.
        heartbeat: Called again and again while torque is switched, which takes a while.
    """

    def __init__(
        self,
        joints: Joints,
        mounts: Sequence[ServoMount],
        ports: Mapping[str, BusPort],
        *,
        supply: float = 12.0,
        board: OpenCr | None = None,
        imu: ImuSource | None = None,
        couplings: Sequence[Coupling] = (),
        watchdog: float = 0.2,
        contacts: int = 0,
        opener: Callable[[str, int], Port] = open_port,
    ) -> None:
        self.joints, self.mounts, self.board, self.imu = joints, tuple(mounts), board, imu
        self.units = Units(self.mounts, supply)
        self._couplings = Couplings(joints, couplings)
        check_mounts(joints, self.mounts, ports, self.units, self._couplings)
        self._ports, self._opener, self._watchdog = dict(ports), opener, watchdog
        self.clock: Clock = WallClock()
        self.links: list[ServoLink] = []
        self._imu_link: ImuLink | None = None
        self._alerts = ServoAlerts(joints, self.mounts)
        self.button = StopButton()
        self.clamps: Counter[str] = Counter({"goal": 0, "gain": 0})
        self.watchdog_trips = 0
        n = len(joints)
        self._counts = np.full((3, n), np.nan)
        self._health = np.full((3, n), np.nan)
        self._answered = np.full(n, -np.inf)
        self._imu_at = -np.inf
        self.arming_stiffness: Array = joints.stiffness
        self._patience = 0.9 * watchdog
        self._contacts = np.zeros(contacts)
        self._realised = np.empty((2, n))
        self._realised[1] = self._couplings.joint_gains(self.units.damping)
        self._gains = b""
        self.heartbeat: Callable[[], None] = lambda: None

    @property
    def lines(self) -> list[ServoLine]:
        """The servos of each bus."""
        return [link.line for link in self.links]

    @property
    def alert_kinds(self) -> tuple[str, ...]:
        """All that a servo of this robot can complain of."""
        return self._alerts.kinds

    @property
    def alerts(self) -> dict[str, tuple[str, ...]]:
        """Joint name to the hardware errors that its servo signals."""
        return self._alerts.now

    @property
    def lost(self) -> dict[str, str]:
        """URL of each port that is gone, to what was seen of it."""
        return {link.bus.port.url: link.lost for link in self.links if link.lost is not None}

    def connect(self) -> None:
        """Open the ports. Nothing moves.

        Raises:
            PortError: One cannot be opened; the others are closed again.
            UsageError: Some ports live on the wall's time and some in a virtual world.
        """
        self.disconnect()
        build = lines_of(self.mounts, self.units, self.board)
        self.links, self._imu_link, self.clock = open_links(
            build, self._ports, self.imu, self._watchdog, self._opener
        )
        self._alerts.watch(self.lines)

    def configure(self) -> None:
        """Check every servo, then assert the settings that the stack relies on. Nothing moves.

        Raises:
            HardwareError: Something is not as wired; nothing has been written.
        """
        buses = {link.line.mounts[0].bus: link.bus for link in self.links}
        set_up(self.joints, self.mounts, buses, self.board)
        for line in self.lines:
            line.bus.exchange.turnaround = TURNAROUND
            line.probe_fast()
        began = self.clock.now()
        for _ in range(ATTEMPTS):
            self.read()
            if (self._answered > began).all():
                break
        else:
            silent = names_of(self.joints, self._answered <= began)
            raise HardwareError(f"no answer to cyclic reads from {silent}; run `windup scan`")
        self.read_health()

    def read_health(self) -> None:
        """Read voltage and temperature of every servo now, where its port is there."""
        for link in self.links:
            link.read_health(self._health)

    def request(self) -> None:
        """Ask every joint for its state."""
        for link in self.links:
            link.request()

    def collect(self) -> Observation:
        """Return the state last asked for."""
        late = False
        for link in self.links:
            valid = link.collect(self._counts, self._health, self._alerts.errors)
            late |= self._note_answers(link.line, valid, link.torque.armed)
        if late:
            self.watchdog_trips += sum(link.clear_watchdogs() for link in self.links)
        self._alerts.update(self.links)
        if self.board is not None:
            self.button.look(self.links)
        if self._imu_link is not None:
            self._imu_link.poll()
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
        goal = shifted_goal(command, self._realised[0]) if block[1:3].any() else block[0]
        if self._couplings:
            goal = self._couplings.servos(goal)
        counts = np.rint(self.units.counts(goal))
        inside = np.minimum(np.maximum(counts, 0.0), self.units.last)
        if not np.array_equal(inside, counts):
            self.clamps["goal"] += 1
        for link in self.links:
            if not link.send_goals(inside[link.line.rows]):
                self.clamps["unarmed"] += 1
        real = np.zeros_like(block)
        angle = self.units.angle(inside)
        real[0] = self._couplings.joints(angle) if self._couplings else angle
        real[3:] = self._realised
        return JointCommand(real)

    def goal_counts(self, pose: Array) -> Array:
        """Return the servos' goals (n,) for a pose of the joints (n,) rad, counts."""
        goal = self._couplings.servos(pose) if self._couplings else pose
        counts: Array = np.clip(np.rint(self.units.counts(goal)), 0.0, self.units.last)
        return counts

    def bus_errors(self) -> Mapping[str, int]:
        """Return kind of error to how often it has happened, over all buses."""
        return count_errors(self.links, self.watchdog_trips)

    def set_torque(self, on: bool) -> TorqueState:
        """Switch all torque, on at the present pose only, and return what was read back.

        Raises:
            HardwareError: Torque on, and a servo cannot be read, or a port was gone since the
                robot was armed; all torque is off.
        """
        self._gains = b""
        if on:
            self.button.forget()
            try:
                return self._switch_on()
            except HardwareError:
                self.set_torque(False)
                raise
        return self._joined([link.switch_off() for link in self.links])

    def rearm(self) -> TorqueState:
        """Check and set every servo again, then switch torque on at the present pose.

        After a port was gone servos may have been without power. Returns what was read back.

        Raises:
            PortError: A port is still gone.
            HardwareError: Something is not as wired; torque stays off.
        """
        if self.lost:
            gone = "; ".join(self.lost.values())
            raise PortError(f"cannot arm again: {gone}")
        self.set_torque(False)
        self.configure()
        for link in self.links:
            link.rearmed()
        return self.set_torque(True)

    def disconnect(self) -> None:
        """Close the ports. Torque that is on stays on, also when the servos' watchdog trips."""
        for link in self.links:
            link.close()
        if self._imu_link is not None:
            self._imu_link.close()
        self.links, self._imu_link = [], None

    def _switch_on(self) -> TorqueState:
        if barred := [link.bus.port.url for link in self.links if link.barred]:
            raise HardwareError(
                f"{', '.join(barred)} went away since the robot was armed; torque stays off "
                "until it is armed again"
            )
        wanted = self._couplings.servo_gains(self.arming_stiffness)
        gains, _ = self.units.p_registers(wanted)
        return self._joined([link.torque.on(gains[link.line.rows]) for link in self.links])

    def _joined(self, states: list[TorqueState]) -> TorqueState:
        """Return the torque of the joints from that of the servos of each bus.

        A joint that two servos move is on, or unknown, if one of them is.
        """
        on: Mask = np.zeros(len(self.joints), dtype=bool)
        unknown: Mask = np.zeros_like(on)
        for link, state in zip(self.links, states, strict=True):
            on[link.line.rows], unknown[link.line.rows] = state.on, state.unknown
        on, unknown = self._couplings.any(on), self._couplings.any(unknown)
        return TorqueState(on, unknown & ~on)

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
        voltage, temperature, measured = self._health.copy()
        answered = self._answered
        if self._couplings:
            position, velocity = map(self._couplings.joints, (position, velocity))
            torque = self._couplings.torques(torque)
            answered = self._couplings.oldest(answered)
        age = now - answered
        state = JointState(position, velocity, torque, voltage, temperature, age, now - measured)
        return Observation(now, state, self._imu_state(now), self._contacts, None)

    def _imu_state(self, now: float) -> ImuState | None:
        if self.imu is not None:
            return self.imu.state(now)
        for link in self.links:
            line = link.line
            if line.board is not None and line.imu is not None:
                return line.board.decode(line.imu, now - self._imu_at)
        return None

    def _send_gains(self, stiffness: Array) -> None:
        wanted = self._couplings.servo_gains(stiffness)
        registers, beyond = self.units.p_registers(wanted)
        self.clamps["gain"] += beyond
        for link in self.links:
            link.send_gains(registers[link.line.rows])
        self._realised[0] = self._couplings.joint_gains(registers * self.units.stiffness)
        self._gains = stiffness.tobytes()
