"""Joints on buses of servos, of one make or of several, behind the joint-command interface."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from windup.hal.backend import Clock
from windup.hal.bus.bus import Bus
from windup.hal.bus.transactions import TURNAROUND
from windup.hal.clock import WallClock
from windup.hal.command import JointCommand, shifted_goal
from windup.hal.coupling import Coupling, Couplings
from windup.hal.errors import HardwareError, PortError
from windup.hal.heartbeat import Heartbeat, beating, no_heartbeat
from windup.hal.imu.opencr import OpenCr
from windup.hal.imu.source import ImuConnection, ImuSource
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation
from windup.hal.port.open_port import open_port
from windup.hal.port.port import Port
from windup.hal.servo_bus.bus_connection import BusConnection, BusPort
from windup.hal.servo_bus.bus_readout import BusReadout
from windup.hal.servo_bus.joint_readings import JointReadings
from windup.hal.servo_bus.joint_torque import JointTorque
from windup.hal.servo_bus.servo_alerts import ServoAlerts, count_errors
from windup.hal.servo_bus.servo_setup import lines_of, names_of, open_links, set_up
from windup.hal.servo_bus.stop_button import StopButton
from windup.hal.servo_bus.units import Units
from windup.hal.servo_bus.wiring import check_mounts
from windup.hal.servos.servo_model import ServoMount
from windup.hal.torque_loss import Loss
from windup.hal.torque_state import TorqueState

__all__ = ["BusPort", "ServoBackend"]

ATTEMPTS = 30


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
        imu: An IMU with a connection of its own.
        couplings: Joints that two servos move together.
        watchdog: Silence after which a bus watchdog freezes the pose, torque on, s; 0 for none.
        contacts: Number of contact sensors that observations have room for; none is measured.
        opener: Opens a port.

    Attributes:
        links: The buses, from `connect` to `disconnect`.
        readings: What the servos last said.
        button: The buttons of the OpenCR: any of them is a stop.
        clamps: Clamp name to the number of commands it changed: "goal" beyond the encoder's range,
            "gain" beyond the register's; "unarmed" and "lost" are goals withheld, of a bus, and of
            joints that may have lost their torque.
        lost_joints: Joint name to how it has lost its torque since the robot was armed. It gets
            no goal until `rearm`.
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
        self.links: list[BusConnection] = []
        self._imu_link: ImuConnection | None = None
        self._alerts = ServoAlerts(joints, self.mounts)
        self.button = StopButton()
        self._torque = JointTorque(joints, self._couplings)
        self.lost_joints: Mapping[str, Loss] = {}
        self.clamps: Counter[str] = Counter(goal=0, gain=0, unarmed=0, lost=0)
        self.watchdog_trips = 0
        n = len(joints)
        self.readings = JointReadings(self.units, self._couplings, imu, contacts)
        self.arming_stiffness: Array = joints.stiffness
        self._realised = np.empty((2, n))
        self._realised[1] = self._couplings.joint_gains(self.units.damping)
        self._gains = b""
        self.heartbeat: Heartbeat = no_heartbeat

    @property
    def lines(self) -> list[BusReadout]:
        """The servos of each bus."""
        return [link.line for link in self.links]

    @property
    def _buses(self) -> list[Bus]:
        return [link.bus for link in self.links]

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

    @property
    def doubtful_joints(self) -> Mapping[str, str]:
        """The joints that are silent, or whose port is gone, and what to do about each."""
        return self._torque.doubts(self.links)

    def connect(self) -> None:
        """Open the ports. Nothing moves.

        Raises:
            PortError: One cannot be opened; the others are closed again.
            UsageError: Some ports live on the wall's time and some in a virtual world.
        """
        self.disconnect()
        build = lines_of(self.joints, self.mounts, self.units, self.board)
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
        with beating(self._buses, self.heartbeat):
            set_up(self.joints, self.mounts, buses, self.board)
        for line in self.lines:
            line.bus.exchange.turnaround = TURNAROUND
            line.reads.probe_fast()
        if silent := self._silent():
            raise HardwareError(f"no answer to cyclic reads from {silent}; run `windup scan`")
        self.read_health()

    def read_health(self) -> None:
        """Read voltage and temperature of every servo now, where its port is there."""
        self.readings.read_health(self.links)

    def _silent(self) -> str:
        """Read until every joint has answered, some times at most; return the names of others."""
        began = self.clock.now()
        for _ in range(ATTEMPTS):
            self.read()
            if (self.readings.answered > began).all():
                break
        return names_of(self.joints, self.readings.answered <= began)

    def request(self) -> None:
        """Ask every joint for its state."""
        for link in self.links:
            link.request()

    def collect(self) -> Observation:
        """Return the state last asked for."""
        calm = True
        for link in self.links:
            self.readings.collect(link, self._alerts.errors)
            calm &= link.calm
        if not calm or self._alerts.now:
            self._see_to(self.links)
        if self.board is not None:
            self.button.update(self.links)
        if self._imu_link is not None:
            self._imu_link.poll()
        return self.readings.observe(self.clock.now(), self.links)

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
        inside = np.minimum(np.maximum(counts, self.units.first), self.units.last)
        if (inside != counts).any():
            self.clamps["goal"] += 1
        real = np.zeros(block.shape)
        angle = self.units.angle(inside)
        real[0] = self._couplings.joints(angle) if self._couplings else angle
        real[3:] = self._realised
        for link in self.links:
            if (clamp := link.send_goals(inside[link.line.rows])) is not None:
                self.clamps[clamp] += 1
            if link.check.withheld is not None:
                real[3:, link.line.rows[link.check.withheld]] = 0.0
        return JointCommand(real)

    def goal_counts(self, pose: Array) -> Array:
        """Return the servos' goals (n,) for a pose of the joints (n,) rad, counts."""
        goal = self._couplings.servos(pose) if self._couplings else pose
        counts = np.rint(self.units.counts(goal))
        return np.asarray(np.clip(counts, self.units.first, self.units.last))

    def bus_errors(self) -> Mapping[str, int]:
        """Return kind of error to how often it has happened, over all buses."""
        return count_errors(self.links, self.watchdog_trips)

    def set_torque(self, on: bool) -> TorqueState:
        """Switch all torque, on at the present pose only, and return what was read back.

        Raises:
            HardwareError: Torque on, and a servo cannot be read, or a port was gone or a joint
                lost its torque since the robot was armed; all torque is off.
        """
        self._gains = b""
        with beating(self._buses, self.heartbeat):
            if not on:
                return self._torque.off(self.links, self.heartbeat)
            self.button.forget()
            wanted = self._couplings.servo_gains(self.arming_stiffness)
            gains, _ = self.units.p_registers(wanted)
            return self._torque.on(self.links, gains, self.heartbeat)

    def rearm(self) -> TorqueState:
        """Check and set every servo again, then switch torque on at the present pose.

        After a port was gone servos may have been without power. Returns what was read back.

        Raises:
            PortError: A port is still gone.
            HardwareError: Something is not as wired; torque stays off.
        """
        self.heartbeat()
        if self.lost:
            gone = "; ".join(self.lost.values())
            raise PortError(f"cannot arm again: {gone}")
        self.set_torque(False)
        self.configure()
        for link in self.links:
            link.rearmed()
        self.lost_joints = {}
        return self.set_torque(True)

    def disconnect(self) -> None:
        """Close the ports. Torque that is on stays on, also when the servos' watchdog trips."""
        for link in self.links:
            link.close()
        if self._imu_link is not None:
            self._imu_link.close()
        self.links, self._imu_link = [], None

    def _see_to(self, links: Sequence[BusConnection]) -> None:
        """Look after whoever was silent, signals an error or has lost its torque."""
        self.lost_joints = self._torque.losses(links)
        if any(link.check.woke for link in links):
            self.watchdog_trips += sum(link.clear_watchdogs() for link in links)
        self._alerts.update(links)

    def _send_gains(self, stiffness: Array) -> None:
        wanted = self._couplings.servo_gains(stiffness)
        registers, beyond = self.units.p_registers(wanted)
        self.clamps["gain"] += beyond
        for link in self.links:
            link.send_gains(registers[link.line.rows])
        self._realised[0] = self._couplings.joint_gains(registers * self.units.stiffness)
        self._gains = stiffness.tobytes()
