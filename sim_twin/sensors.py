"""What the twin's sensors say: encoder counts, contact forces, the IMU, and how late they are."""

from collections import deque
from math import pi
from typing import NamedTuple

import mujoco
import numpy as np

from windup.hal.joints import Array
from windup.hal.observation import BaseState, ImuState, JointState, Observation
from windup.robots import Imu, RobotDescription
from windup.sim_twin.imu_errors import ImuErrors
from windup.sim_twin.joint_indices import as_index
from windup.sim_twin.twin import Twin

AMBIENT = 25.0


class Snapshot(NamedTuple):
    """The raw state at one instant; see MuJoCo for the layouts."""

    time: float
    qpos: Array
    qvel: Array
    force: Array
    sensors: Array


class Sensors:
    """Reads a twin as its sensors would.

    Args:
        twin: The twin.
        delay: Age of everything that is read, s.
        true_base: Put the true base state into observations.
        imu_errors: What the IMU makes of the motion; by default it is perfect.
    """

    def __init__(
        self,
        twin: Twin,
        *,
        delay: float = 0.0,
        true_base: bool = True,
        imu_errors: ImuErrors | None = None,
    ) -> None:
        self.twin, self.delay, self.true_base = twin, delay, true_base
        self._errors = imu_errors if twin.robot.imu is not None else None
        robot, model = twin.robot, twin.model
        n = len(robot.joints)
        self._counts = _counts_per_rad(robot)
        self._encoders = bool(self._counts.any())
        touch = [model.sensor(name).adr[0] for name in robot.contacts.names]
        self._contacts = as_index(np.array(touch, dtype=np.intp))
        self._position, self._velocity = twin.indices.position, twin.indices.velocity
        self._fixed = twin.fixed_base() if robot.fixed else None
        self._find_imu(robot.imu, model)
        self._voltage = _constant(n, twin.supply)
        self._temperature = _constant(n, AMBIENT)
        self._age = _constant(n, delay)
        self._data = data = twin.data
        self._views = (data.qpos, data.qvel, data.actuator_force, data.sensordata)
        self._line: deque[Snapshot] = deque()
        if delay > 0.0:
            self._line = deque(maxlen=round(delay / twin.timestep) + 1)
        if delay > 0.0 or self._errors is not None:
            twin.on_step = self._record
            twin.on_jump = self._line.clear

    def _find_imu(self, imu: Imu | None, model: mujoco.MjModel) -> None:
        """Look up where the IMU's sensors stand among all."""
        self._imu = imu
        if imu is not None:
            self._gyro = _place(model.sensor(imu.gyro).adr[0], 3)
            self._accelerometer = _place(model.sensor(imu.accelerometer).adr[0], 3)
            self._motion = np.r_[self._gyro, self._accelerometer]
            name = imu.orientation
            self._orientation = None if name is None else _place(model.sensor(name).adr[0], 4)

    def read(self) -> Observation:
        """Return the observation that is available now."""
        snapshot = self._line[0] if self._line else self._snapshot()
        qpos, qvel, sensors = snapshot.qpos, snapshot.qvel, snapshot.sensors
        position = qpos[self._position]
        if self._encoders:
            position = np.rint(position * self._counts)
            position /= self._counts
        health = self._voltage, self._temperature, self._age, self._age
        joints = JointState(position, qvel[self._velocity], snapshot.force, *health)
        base = None
        if self.true_base:
            base = self._fixed or BaseState(qpos[:3], qpos[3:7], qvel[:3], qvel[3:6])
        return Observation(
            snapshot.time, joints, self._read_imu(sensors), sensors[self._contacts], base
        )

    def _read_imu(self, sensors: Array) -> ImuState | None:
        if self._imu is None:
            return None
        fused = self._orientation is not None and self._errors is None
        orientation = sensors[self._orientation] if fused else None
        return ImuState(orientation, sensors[self._gyro], sensors[self._accelerometer], self.delay)

    def _snapshot(self) -> Snapshot:
        qpos, qvel, force, sensors = self._views
        sensors = sensors.copy()
        if self._errors is not None:
            sensors[self._motion] = self._errors.sample(sensors[self._motion])
        return Snapshot(self._data.time, qpos.copy(), qvel.copy(), force.copy(), sensors)

    def _record(self) -> None:
        if self._errors is not None:
            self._errors.filter_motion(self._views[3][self._motion])
        if self.delay > 0.0:
            self._line.append(self._snapshot())


def _counts_per_rad(robot: RobotDescription) -> Array:
    """Return (n,) counts of each joint's encoder; 0 where it has none."""
    return np.array(
        [
            servo.model.counts_per_rev / (2.0 * pi) * servo.ratio if servo else 0.0
            for servo in robot.servos
        ]
    )


def _place(start: int, size: int) -> slice:
    return slice(int(start), int(start) + size)


def _constant(n: int, value: float) -> Array:
    array = np.full(n, value)
    array.setflags(write=False)
    return array
