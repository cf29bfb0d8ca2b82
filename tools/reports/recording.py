"""Records every tick of a run; the arrays are made when they are first asked for."""

from typing import NamedTuple

import numpy as np

from windup.control.loop import Recorder
from windup.hal.command import JointCommand
from windup.hal.joints import Array
from windup.hal.observation import BaseState, ImuState, Observation
from windup.tools.reports.run_data import RunData

NAN3, NAN4 = np.full(3, np.nan), np.full(4, np.nan)
NO_BASE = BaseState(NAN3, NAN4, NAN3, NAN3, confidence=0.0)
NO_IMU = ImuState(None, NAN3, NAN3, np.nan)


class Row(NamedTuple):
    """One tick: references only, so that recording costs the tick next to nothing.

    Attributes:
        observation: What was measured.
        asked: What the controller asked for.
        applied: What the joints really got.
        tick_time: Wall time of the tick, s.
    """

    observation: Observation
    asked: Array
    applied: Array
    tick_time: float


class Recording:
    """Records the ticks of one run, and hands them on to another recorder.

    Args:
        robot: Name of the robot.
        joints: Names of its n joints.
        contacts: Names of its k contact sensors.
        recorder: Records every tick, too.
    """

    def __init__(
        self,
        robot: str,
        joints: tuple[str, ...],
        contacts: tuple[str, ...],
        recorder: Recorder | None = None,
    ) -> None:
        self.robot, self.joints, self.contacts = robot, joints, contacts
        self._recorder = recorder
        self._rows: list[Row] = []
        self._data: RunData | None = None

    def record(
        self,
        observation: Observation,
        asked: JointCommand,
        applied: JointCommand,
        tick_time: float,
        lateness: float,
        tick: int,
        missed: int,
    ) -> None:
        """Record a tick; see `windup.control.loop.Recorder`."""
        self._rows.append(Row(observation, asked.block, applied.block, tick_time))
        if self._recorder is not None:
            self._recorder.record(observation, asked, applied, tick_time, lateness, tick, missed)

    def data(self, reason: str) -> RunData:
        """Return what was recorded so far, of a run that ended for `reason`."""
        if self._data is None or len(self._data.arrays["time"]) < len(self._rows):
            arrays = self._arrays()
            self._data = RunData(self.robot, reason, self.joints, self.contacts, arrays)
        return self._data

    def _arrays(self) -> dict[str, Array]:
        rows, n, k = self._rows, len(self.joints), len(self.contacts)
        seen = [row.observation for row in rows]
        states = [observation.joints for observation in seen]
        bases = [observation.base or NO_BASE for observation in seen]
        imus = [observation.imu or NO_IMU for observation in seen]
        time = np.array([observation.time for observation in seen])
        return {
            "time": time - time[:1],
            "position_asked": _table([row.asked[0] for row in rows], n),
            "position_applied": _table([row.applied[0] for row in rows], n),
            "position": _table([state.position for state in states], n),
            "velocity": _table([state.velocity for state in states], n),
            "torque": _table([state.torque for state in states], n),
            "voltage": _table([state.voltage for state in states], n),
            "temperature": _table([state.temperature for state in states], n),
            "contacts": _table([observation.contacts for observation in seen], k),
            "base_position": _table([base.position for base in bases], 3),
            "base_orientation": _table([base.orientation for base in bases], 4),
            "base_linear_velocity": _table([base.linear_velocity for base in bases], 3),
            "base_angular_velocity": _table([base.angular_velocity for base in bases], 3),
            "imu_angular_velocity": _table([imu.angular_velocity for imu in imus], 3),
            "imu_acceleration": _table([imu.acceleration for imu in imus], 3),
            "tick_time": np.array([row.tick_time for row in rows]),
        }


def _table(rows: list[Array], columns: int) -> Array:
    """Return rows as an array (t, columns), also if there are none."""
    return np.array(rows, dtype=np.float64).reshape(len(rows), columns)
