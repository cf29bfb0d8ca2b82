"""Torque of a robot's joints, over all of its buses and couplings."""

from collections.abc import Sequence

import numpy as np

from windup.hal.errors import HardwareError
from windup.hal.heartbeat import Heartbeat
from windup.hal.joints import Array, Joints, Mask
from windup.hal.servo_bus.bus_connection import BusConnection
from windup.hal.servo_bus.coupling import Couplings
from windup.hal.torque_loss import SILENT, Loss
from windup.hal.torque_state import TorqueState

BOOT_TIME = 0.5
"""Maximum boot time of a silent servo until it can be read back as off, s (assumed)."""
PAUSE = 20e-3
"""Time between two attempts to switch off silent servos, s."""


class JointTorque:
    """Switches and reports the torque of the joints; a coupled joint depends on two servos.

    Args:
        joints: The joints.
        couplings: Joints that are driven by two servos together.
    """

    def __init__(self, joints: Joints, couplings: Couplings) -> None:
        self._joints, self._couplings = joints, couplings

    def on(self, links: Sequence[BusConnection], gains: Array, heartbeat: Heartbeat) -> TorqueState:
        """Switch torque on at the present pose, with P registers `gains` (n,).

        Raises:
            HardwareError: A servo cannot be read or switched on, or the robot has to be rearmed,
                because a port or the torque of a joint was lost. Torque has been switched off
                everywhere; the message says whether that could be read back.
        """
        try:
            self._check_armable(links)
            return self._joined(links, [link.switch_on(gains[link.readout.rows]) for link in links])
        except HardwareError as error:
            state = self.off(links, heartbeat)
            where = state.names(self._joints, ~state.off)
            now = f"is not known to be off at {where}" if where else "is off"
            raise type(error)(f"{error}; torque {now}") from None

    def off(self, links: Sequence[BusConnection], heartbeat: Heartbeat) -> TorqueState:
        """Switch torque off and return the state that was read back.

        Servos that answer are switched off and read back first; then silent ones are retried for
        `BOOT_TIME`, as they may be booting.
        """
        for link in links:
            link.send_off()
        states = [link.switch_off() for link in links]
        until = max((link.clock.now() for link in links), default=0.0) + BOOT_TIME
        while _worth_waiting(links, states) and links[0].clock.now() < until:
            heartbeat()
            links[0].clock.wait_until(links[0].clock.now() + PAUSE)
            states = [link.retry_off(s) for link, s in zip(links, states, strict=True)]
        return self._joined(links, states)

    def _check_armable(self, links: Sequence[BusConnection]) -> None:
        if lost_ports := [link.bus.port.url for link in links if link.goals_withheld]:
            raise HardwareError(
                f"{', '.join(lost_ports)} was disconnected after arming; arm again with `rearm`"
            )
        if lost := self.losses(links):
            raise HardwareError(
                f"{', '.join(lost)} lost torque after arming; arm again with `rearm`"
            )

    def losses(self, links: Sequence[BusConnection]) -> dict[str, Loss]:
        """Map joint name to how it lost its torque since the robot was armed."""
        lost: dict[str, Loss] = {}
        for link in links:
            for row, loss in link.check.losses.items():
                lost |= dict.fromkeys(self._moved_by(link, [row]), loss)
        return lost

    def torque_unknown(self, links: Sequence[BusConnection]) -> dict[str, str]:
        """Map joint name to the remedy, for joints whose torque state is unknown."""
        doubts: dict[str, str] = {}
        for link in links:
            if link.lost is not None:
                every = range(len(link.readout.ids))
                doubts |= dict.fromkeys(self._moved_by(link, every), link.lost)
            elif link.check.suspects.any():
                rows = np.flatnonzero(link.check.suspects).tolist()
                doubts |= dict.fromkeys(self._moved_by(link, rows), SILENT)
        return doubts

    def _moved_by(self, link: BusConnection, rows: Sequence[int]) -> list[str]:
        """Return the names of the joints that are driven by the servos at `rows` of a bus."""
        servos: Mask = np.zeros(len(self._joints), dtype=bool)
        servos[link.readout.rows[list(rows)]] = True
        return np.array(self._joints.names)[self._couplings.any(servos)].tolist()

    def _joined(self, links: Sequence[BusConnection], states: Sequence[TorqueState]) -> TorqueState:
        """Return the torque state of the joints from those of the servos of each bus.

        A coupled joint is on if one of its servos is on, and else unknown if one is unknown.
        """
        on: Mask = np.zeros(len(self._joints), dtype=bool)
        unknown: Mask = np.zeros_like(on)
        for link, state in zip(links, states, strict=True):
            on[link.readout.rows], unknown[link.readout.rows] = state.on, state.unknown
        on, unknown = self._couplings.any(on), self._couplings.any(unknown)
        return TorqueState(on, unknown & ~on)


def _worth_waiting(links: Sequence[BusConnection], states: Sequence[TorqueState]) -> bool:
    """Return whether a servo that is not read back as off may still answer this process."""
    pairs = zip(links, states, strict=True)
    return any(not state.all_off and not link.port_is_lost_for_good for link, state in pairs)
