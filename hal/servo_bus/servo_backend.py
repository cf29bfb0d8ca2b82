"""The backend of real robots: joints on servo buses of one or several families."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from windup.hal.backend import Clock
from windup.hal.bus.bus import Bus
from windup.hal.bus.transactions import TURNAROUND
from windup.hal.clock import WallClock
from windup.hal.command import JointCommand, shifted_goal
from windup.hal.errors import HardwareError, PortError
from windup.hal.heartbeat import Heartbeat, no_heartbeat, with_heartbeat
from windup.hal.imu.opencr import OpenCr
from windup.hal.imu.source import ImuConnection, ImuSource
from windup.hal.joints import Array, Flags, Joints
from windup.hal.observation import Observation
from windup.hal.port.open_port import open_port
from windup.hal.port.port import Port
from windup.hal.servo_bus.bus_connection import BusConnection, BusPort
from windup.hal.servo_bus.bus_readout import BusReadout
from windup.hal.servo_bus.coupling import Coupling, Couplings
from windup.hal.servo_bus.driver_clamps import DriverClamps
from windup.hal.servo_bus.joint_readings import JointReadings
from windup.hal.servo_bus.joint_torque import JointTorque
from windup.hal.servo_bus.servo_alerts import ServoAlerts, count_errors
from windup.hal.servo_bus.servo_setup import (
    build_readouts,
    open_links,
    set_up_servos,
    silent_joints,
)
from windup.hal.servo_bus.stop_button import StopButton
from windup.hal.servo_bus.units import Units
from windup.hal.servo_bus.wiring import check_mounts
from windup.hal.servos.servo_model import ServoMount
from windup.hal.torque_loss import Loss
from windup.hal.torque_state import TorqueState

__all__ = ["BusPort", "ServoBackend"]


class ServoBackend:
    """The joints of one robot on k buses of servos, each bus of one family.

    The servos' control law is that of `ServoModel`: stiffness becomes a P register, sent when it
    changes; velocity and torque become a shifted goal; damping is that of the motor. A joint
    without a valid and plausible answer keeps its last state, with its age. So do the joints of a
    bus whose port is lost: the port is reopened when it is back, with torque off, and its joints
    get no goals until `rearm`.

    Args:
        joints: The joints.
        mounts: The servo of each joint, in the same order.
        ports: Maps bus name to its port.
        supply: Supply voltage used to convert stiffness to P registers, V.
        board: The OpenCR, read with the servos of its bus.
        imu: An IMU with its own connection.
        couplings: Joints that are driven by two servos together.
        watchdog: Silence after which a Bus Watchdog freezes the pose, torque on, s; 0 for none.
        contacts: Number of contact sensors in observations; their forces are always 0.
        opener: Opens a port.

    Attributes:
        links: The buses, from `connect` to `disconnect`.
        readings: Last readings of the servos.
        button: The buttons of the OpenCR; each of them is a stop button.
        clamps: Maps clamp to the number of commands it changed: "goal" beyond the encoder's range,
            "gain" beyond that of the register; "unarmed" and "lost" are goals withheld from a bus,
            and from joints that may have lost their torque.
        lost_joints: Maps joint name to how its torque was lost; it gets no goals until `rearm`.
        watchdog_trips: Number of Bus Watchdogs that fired and were cleared.
        arming_stiffness: (n,) stiffness at torque enable, N m/rad.
        heartbeat: Called repeatedly while torque is switched, which takes a while.
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
        self.watchdog_trips = 0
        n = len(joints)
        self._clamped = DriverClamps(self._couplings, n)
        self.clamps = self._clamped.counts
        self.readings = JointReadings(self.units, self._couplings, imu, contacts)
        self.arming_stiffness: Array = joints.stiffness
        self._realised = np.empty((2, n))
        self._realised[1] = self._couplings.joint_gains(self.units.damping)
        self._gains = b""
        self.heartbeat: Heartbeat = no_heartbeat

    @property
    def readouts(self) -> list[BusReadout]:
        """The readout of each bus."""
        return [link.readout for link in self.links]

    @property
    def _buses(self) -> list[Bus]:
        return [link.bus for link in self.links]

    @property
    def alert_kinds(self) -> tuple[str, ...]:
        """All kinds of alert that the servos of this robot can report."""
        return self._alerts.kinds

    @property
    def alerts(self) -> dict[str, tuple[str, ...]]:
        """Maps joint name to the hardware errors that its servo reports."""
        return self._alerts.now

    @property
    def clamp_bits(self) -> Flags | None:
        """(n,) clamps that changed each joint's part of the last command; see `ClampReporter`."""
        return self._clamped.bits

    @property
    def lost(self) -> dict[str, str]:
        """Maps the URL of each lost port to a description of the failure."""
        return {link.bus.port.url: link.lost for link in self.links if link.lost is not None}

    @property
    def doubtful_joints(self) -> Mapping[str, str]:
        """Maps joint name to the remedy, for joints whose torque state is unknown."""
        return self._torque.torque_unknown(self.links)

    def connect(self) -> None:
        """Open the ports. Nothing moves.

        Raises:
            PortError: A port cannot be opened; the others are closed again.
            UsageError: The ports do not share one clock (wall clock, or one virtual clock).
        """
        self.disconnect()
        build = build_readouts(self.joints, self.mounts, self.units, self.board)
        self.links, self._imu_link, self.clock = open_links(
            build, self._ports, self.imu, self._watchdog, self._opener
        )
        self._alerts.watch(self.readouts)

    def configure(self) -> None:
        """Check every servo, then write the required settings that differ. Nothing moves.

        Raises:
            HardwareError: The wiring differs from robot.toml, and nothing has been written; or a
                servo does not answer cyclic reads.
        """
        buses = {link.readout.mounts[0].bus: link.bus for link in self.links}
        with with_heartbeat(self._buses, self.heartbeat):
            set_up_servos(self.joints, self.mounts, buses, self.board)
        for readout in self.readouts:
            readout.bus.exchange.turnaround = TURNAROUND
            readout.reads.probe_fast()
        if silent := silent_joints(self.joints, self.readings, self.read, self.clock.now()):
            raise HardwareError(f"no answer to cyclic reads from {silent}; run `windup scan`")
        self.read_health()

    def read_health(self) -> None:
        """Read voltage and temperature of every servo now, except on lost ports."""
        self.readings.read_health(self.links)

    def request(self) -> None:
        """Request the state of every joint, without waiting for it."""
        for link in self.links:
            link.request()

    def collect(self) -> Observation:
        """Wait for the state last requested and return it."""
        all_well = True
        for link in self.links:
            self.readings.collect(link, self._alerts.errors)
            all_well &= link.all_well
        if not all_well or self._alerts.now:
            self._see_to(self.links)
        if self.board is not None:
            self.button.update(self.links)
        if self._imu_link is not None:
            self._imu_link.poll()
        return self.readings.observe(self.clock.now(), self.links)

    def read(self) -> Observation:
        """Return the present state: `request` followed by `collect`."""
        self.request()
        return self.collect()

    def write(self, command: JointCommand) -> JointCommand:
        """Send a command and return the command that the servos really apply."""
        block = command.block
        if block[3].tobytes() != self._gains:
            self._send_gains(block[3])
        goal = shifted_goal(command, self._realised[0]) if block[1:3].any() else block[0]
        if self._couplings:
            goal = self._couplings.servos(goal)
        counts = np.rint(self.units.counts(goal))
        inside = np.minimum(np.maximum(counts, self.units.first), self.units.last)
        self._clamped.begin()
        if (outside := inside != counts).any():
            self._clamped.note("goal", outside)
        real = np.zeros(block.shape)
        angle = self.units.angle(inside)
        real[0] = self._couplings.joints(angle) if self._couplings else angle
        real[3:] = self._realised
        for link in self.links:
            rows = link.readout.rows
            if (clamp := link.send_goals(inside[rows])) is not None:
                self._clamped.note_withheld(clamp, rows, link.check.withheld)
            if link.check.withheld is not None:
                real[3:, rows[link.check.withheld]] = 0.0
        return JointCommand(real)

    def goal_counts(self, pose: Array) -> Array:
        """Return the servos' goals (n,), counts, for a pose of the joints (n,) rad."""
        goal = self._couplings.servos(pose) if self._couplings else pose
        counts = np.rint(self.units.counts(goal))
        return np.asarray(np.clip(counts, self.units.first, self.units.last))

    def bus_errors(self) -> Mapping[str, int]:
        """Return the number of errors by kind, over all buses."""
        return count_errors(self.links, self.watchdog_trips)

    def set_torque(self, on: bool) -> TorqueState:
        """Switch torque off, or on at the present pose, and return what was read back.

        Raises:
            HardwareError: Torque was to go on, but a servo cannot be read, or a port or the torque
                of a joint was lost since the robot was armed; torque is switched off everywhere.
        """
        self._gains = b""
        with with_heartbeat(self._buses, self.heartbeat):
            if not on:
                return self._torque.off(self.links, self.heartbeat)
            self.button.reset()
            wanted = self._couplings.servo_gains(self.arming_stiffness)
            gains, _ = self.units.p_registers(wanted)
            return self._torque.on(self.links, gains, self.heartbeat)

    def rearm(self) -> TorqueState:
        """Check and configure every servo again, then switch torque on at the present pose.

        While a port was lost, servos may have lost power. Returns what was read back.

        Raises:
            PortError: A port is still missing.
            HardwareError: The wiring differs from robot.toml; torque stays off.
        """
        self.heartbeat()
        if self.lost:
            gone = "; ".join(self.lost.values())
            raise PortError(f"cannot arm again: {gone}")
        self.set_torque(False)
        self.configure()
        for link in self.links:
            link.end_withholding()
        self.lost_joints = {}
        return self.set_torque(True)

    def disconnect(self) -> None:
        """Close the ports. Torque that is on stays on, even after the Bus Watchdog fires."""
        for link in self.links:
            link.close()
        if self._imu_link is not None:
            self._imu_link.close()
        self.links, self._imu_link = [], None

    def _see_to(self, links: Sequence[BusConnection]) -> None:
        """Update losses, watchdogs and alerts after silence, an error or a loss of torque."""
        self.lost_joints = self._torque.losses(links)
        if any(link.check.watchdog_may_have_fired for link in links):
            self.watchdog_trips += sum(link.clear_watchdogs() for link in links)
        self._alerts.update(links)

    def _send_gains(self, stiffness: Array) -> None:
        wanted = self._couplings.servo_gains(stiffness)
        registers, beyond = self.units.p_registers(wanted)
        self._clamped.note_gains(beyond)
        for link in self.links:
            link.send_gains(registers[link.readout.rows])
        self._realised[0] = self._couplings.joint_gains(registers * self.units.stiffness)
        self._gains = stiffness.tobytes()
