"""The MuJoCo twin behind the backend interface, with a clock that steps the physics."""

import time as wall
from math import floor

import numpy as np

from windup.hal.clock import sleep_until
from windup.hal.command import JointCommand
from windup.hal.joints import Joints
from windup.hal.observation import Observation
from windup.hal.torque_state import TorqueState
from windup.sim_twin.imu_errors import ImuErrors
from windup.sim_twin.sensors import Sensors
from windup.sim_twin.servo.servo_motor import ServoDrive, TorqueDrive
from windup.sim_twin.twin import Twin


class TwinClock:
    """Simulated time: a wait steps the physics, at full speed or paced by the wall clock.

    When paced, `now` follows the wall clock even while the physics lags behind: a controller that
    computes too long misses its tick, as it does on a robot.

    Args:
        twin: The twin.
        paced: Let simulated time pass at the rate of real time.
    """

    def __init__(self, twin: Twin, *, paced: bool = False) -> None:
        self.twin, self.paced = twin, paced
        self._data, self._timestep = twin.data, twin.timestep
        self._origin: float | None = None

    def align(self) -> None:
        """Make the present simulated time correspond to the present wall-clock time."""
        self._origin = wall.monotonic() - self._data.time if self.paced else None

    def now(self) -> float:
        """Return the time, s, in whole physics steps; it stands still until a wait or `align`."""
        if self._origin is None:
            return self._data.time
        behind = floor((wall.monotonic() - self._origin - self._data.time) / self._timestep)
        return self._data.time + max(behind, 0) * self._timestep

    def wait_until(self, time: float) -> None:
        """Step the physics until `time`, s; when paced, also wait for the wall clock."""
        if self.paced and self._origin is None:
            self.align()
        steps = round((time - self._data.time) / self._timestep)
        if steps > 0:
            self.twin.step(steps)
        if self._origin is not None:
            sleep_until(self._origin + self._data.time)


class TwinBackend:
    """Implements the backend interface (joint commands out, observations in) on a twin.

    Args:
        twin: The twin.
        paced: See `TwinClock`.
        sensor_delay: Latency of all sensor readings, s; by default the robot description's.
        true_base: Put the true base state into observations.
        imu_errors: Error model of the IMU; by default the IMU is perfect.
    """

    def __init__(
        self,
        twin: Twin,
        *,
        paced: bool = False,
        sensor_delay: float | None = None,
        true_base: bool = True,
        imu_errors: ImuErrors | None = None,
    ) -> None:
        self.twin = twin
        self.clock = TwinClock(twin, paced=paced)
        self.joints: Joints = twin.robot.joints
        delay = twin.robot.drive.sensor_delay if sensor_delay is None else sensor_delay
        self.sensors = Sensors(twin, delay=delay, true_base=true_base, imu_errors=imu_errors)
        self._drive: ServoDrive | TorqueDrive = (
            ServoDrive(twin.model, twin.robot, twin.supply, twin.world.plant.stiffness)
            if twin.robot.drive.kind == "servo"
            else TorqueDrive(twin.model, twin.robot, twin.world.plant.stiffness)
        )
        self._ctrl = twin.data.ctrl

    def connect(self) -> None:
        """Do nothing: there is no port to open."""

    def configure(self) -> None:
        """Do nothing: the twin is built from the robot's file and has no registers to check."""

    def disconnect(self) -> None:
        """Do nothing: there is no port to close."""

    def request(self) -> None:
        """Do nothing: readings need no request on a twin."""

    def collect(self) -> Observation:
        """Return the present observation, with sensor delay and errors."""
        return self.sensors.read()

    def read(self) -> Observation:
        """Return the present observation, with sensor delay and errors."""
        return self.sensors.read()

    def write(self, command: JointCommand) -> JointCommand:
        """Apply a command after the twin's delay and return it as the joints realise it."""
        return self._drive.write(command, self._ctrl)

    def set_torque(self, on: bool) -> TorqueState:
        """Switch all actuators on or off and return the resulting torque state."""
        self.twin.powered = on
        return TorqueState.known(np.full(len(self.joints), self.twin.powered))
