"""The torque of a robot's joints, over all of its buses and through their linkages."""

from collections.abc import Sequence

import numpy as np

from windup.hal.coupling import Couplings
from windup.hal.errors import HardwareError
from windup.hal.heartbeat import Heartbeat
from windup.hal.joints import Array, Joints, Mask
from windup.hal.servo_bus.bus_connection import BusConnection
from windup.hal.torque_loss import SILENT, Loss
from windup.hal.torque_state import TorqueState

BOOT_TIME = 0.5
"""How long a servo that is silent may boot until it can be read as off, s (assumed)."""
PAUSE = 20e-3
"""Between two attempts to switch off who was silent, s."""


class JointTorque:
    """What the torque switches of some buses mean for the joints; two servos may move one.

    Args:
        joints: The joints.
        couplings: Which of them two servos move together.
    """

    def __init__(self, joints: Joints, couplings: Couplings) -> None:
        self._joints, self._couplings = joints, couplings

    def on(self, links: Sequence[BusConnection], gains: Array, heartbeat: Heartbeat) -> TorqueState:
        """Switch torque on at the present pose, P registers (n,) `gains`.

        Raises:
            HardwareError: A servo cannot be read or does not take it, or the robot has to be armed
                again, because a port was gone or a joint has lost its torque. Torque has been
                switched off everywhere; the message says whether that could be read back.
        """
        try:
            self._check_armable(links)
            return self._joined(links, [link.switch_on(gains[link.line.rows]) for link in links])
        except HardwareError as error:
            state = self.off(links, heartbeat)
            where = state.names(self._joints, ~state.off)
            now = f"is not known to be off at {where}" if where else "is off"
            raise type(error)(f"{error}; torque {now}") from None

    def off(self, links: Sequence[BusConnection], heartbeat: Heartbeat) -> TorqueState:
        """Switch torque off and return what was read back.

        Whoever answers is off and read at once; then the silent ones are given time to boot.
        """
        for link in links:
            link.send_off()
        states = [link.switch_off() for link in links]
        until = max((link.clock.now() for link in links), default=0.0) + BOOT_TIME
        while _worth_waiting(links, states) and links[0].clock.now() < until:
            heartbeat()
            links[0].clock.wait_until(links[0].clock.now() + PAUSE)
            states = [link.insist_off(s) for link, s in zip(links, states, strict=True)]
        return self._joined(links, states)

    def _check_armable(self, links: Sequence[BusConnection]) -> None:
        if barred := [link.bus.port.url for link in links if link.barred]:
            raise HardwareError(
                f"{', '.join(barred)} went away since the robot was armed; arm it again by `rearm`"
            )
        if lost := self.losses(links):
            raise HardwareError(
                f"{', '.join(lost)} lost torque since the robot was armed; arm it again by `rearm`"
            )

    def losses(self, links: Sequence[BusConnection]) -> dict[str, Loss]:
        """Return joint name to how it has lost its torque since the robot was armed."""
        lost: dict[str, Loss] = {}
        for link in links:
            for row, loss in link.check.losses.items():
                lost |= dict.fromkeys(self._moved_by(link, [row]), loss)
        return lost

    def doubts(self, links: Sequence[BusConnection]) -> dict[str, str]:
        """Return the joints of which nobody knows whether they have torque, and what to do."""
        doubts: dict[str, str] = {}
        for link in links:
            if link.lost is not None:
                every = range(len(link.line.ids))
                doubts |= dict.fromkeys(self._moved_by(link, every), link.lost)
            elif link.check.suspects.any():
                rows = np.flatnonzero(link.check.suspects).tolist()
                doubts |= dict.fromkeys(self._moved_by(link, rows), SILENT)
        return doubts

    def _moved_by(self, link: BusConnection, rows: Sequence[int]) -> list[str]:
        """Return the names of the joints that the servos in some `rows` of a line move."""
        servos: Mask = np.zeros(len(self._joints), dtype=bool)
        servos[link.line.rows[list(rows)]] = True
        return np.array(self._joints.names)[self._couplings.any(servos)].tolist()

    def _joined(self, links: Sequence[BusConnection], states: Sequence[TorqueState]) -> TorqueState:
        """Return the torque of the joints from that of the servos of each bus.

        A joint that two servos move is on, or unknown, if one of them is.
        """
        on: Mask = np.zeros(len(self._joints), dtype=bool)
        unknown: Mask = np.zeros_like(on)
        for link, state in zip(links, states, strict=True):
            on[link.line.rows], unknown[link.line.rows] = state.on, state.unknown
        on, unknown = self._couplings.any(on), self._couplings.any(unknown)
        return TorqueState(on, unknown & ~on)


def _worth_waiting(links: Sequence[BusConnection], states: Sequence[TorqueState]) -> bool:
    """Return whether a servo that is not known to be off may still answer this process."""
    pairs = zip(links, states, strict=True)
    return any(not state.all_off and not link.gone_for_good for link, state in pairs)
