"""Last readings of the servos of a robot, and the observation computed from them."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from windup.hal.imu.source import ImuSource
from windup.hal.joints import Array, Mask
from windup.hal.observation import ImuState, JointState, Observation
from windup.hal.servo_bus.bus_connection import BusConnection
from windup.hal.servo_bus.coupling import Couplings
from windup.hal.servo_bus.units import Units


class JointReadings:
    """The last readings of n servos; each bus fills in those of its own servos.

    Args:
        units: Unit conversion of the servos.
        couplings: Joints that are driven by two servos together.
        imu: An IMU on its own port; if None, that of an OpenCR on one of the buses, if any.
        contacts: Number of contact sensors in observations; their forces are always 0.

    Attributes:
        answered: (n,) time when each servo last answered, s.
    """

    def __init__(
        self, units: Units, couplings: Couplings, imu: ImuSource | None, contacts: int
    ) -> None:
        n = units.scale.shape[1]
        self._units, self._couplings, self._imu = units, couplings, imu
        self._counts = np.full((3, n), np.nan)
        self._health = np.full((3, n), np.nan)
        self._contacts = np.zeros(contacts)
        self._imu_at = -np.inf
        self.answered: Array = np.full(n, -np.inf)

    def collect(self, link: BusConnection, error: npt.NDArray[np.uint8]) -> None:
        """Collect and timestamp the answers on one bus; error bytes are stored in `error` (n,)."""
        valid: Mask = link.collect(self._counts, self._health, error)
        readout = link.readout
        self.answered[readout.row_index if readout.all_well else readout.rows[valid]] = (
            link.answered_at
        )
        if readout.imu_fresh:
            self._imu_at = link.answered_at

    def read_health(self, links: Sequence[BusConnection]) -> None:
        """Read voltage and temperature of all servos now; later the cycle refreshes them."""
        for link in links:
            link.read_health(self._health)

    def observe(self, now: float, links: Sequence[BusConnection]) -> Observation:
        """Return the observation for the time `now`, s."""
        position, velocity, torque = self._units.to_si(self._counts)
        voltage, temperature, measured = self._health.copy()
        answered = self.answered
        if self._couplings:
            position, velocity = map(self._couplings.joints, (position, velocity))
            torque = self._couplings.torques(torque)
            answered = self._couplings.oldest(answered)
        age = now - answered
        state = JointState(position, velocity, torque, voltage, temperature, age, now - measured)
        return Observation(now, state, self.imu_state(now, links), self._contacts, None)

    def imu_state(self, now: float, links: Sequence[BusConnection]) -> ImuState | None:
        """Return the last IMU sample with its age at `now` s, or None without an IMU."""
        if self._imu is not None:
            return self._imu.state(now)
        for link in links:
            readout = link.readout
            if readout.board is not None and readout.imu is not None:
                return readout.board.decode(readout.imu, now - self._imu_at)
        return None
