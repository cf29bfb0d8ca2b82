"""The twin as a backend: the same records, and a clock that steps physics."""

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
    """Simulated time: waiting steps the physics, as fast as it can or paced by the wall.

    Paced, `now` is what the wall says it should be: whoever computes too long comes too late,
    as on a robot, and the physics goes on without them.

    Args:
        twin: The twin.
        paced: Let simulated time pass as real time does.
    """

    def __init__(self, twin: Twin, *, paced: bool = False) -> None:
        self.twin, self.paced = twin, paced
        self._data, self._timestep = twin.data, twin.timestep
        self._origin: float | None = None

    def align(self) -> None:
        """Let the wall's time count from here: the present simulated time is now."""
        self._origin = wall.monotonic() - self._data.time if self.paced else None

    def now(self) -> float:
        """Return the time, s, in whole physics steps; before any wait and `align` it stands."""
        if self._origin is None:
            return self._data.time
        behind = floor((wall.monotonic() - self._origin - self._data.time) / self._timestep)
        return self._data.time + max(behind, 0) * self._timestep

    def wait_until(self, time: float) -> None:
        """Step the physics until it is `time` s, and wait for the wall where the clock is paced."""
        if self.paced and self._origin is None:
            self.align()
        steps = round((time - self._data.time) / self._timestep)
        if steps > 0:
            self.twin.step(steps)
        if self._origin is not None:
            sleep_until(self._origin + self._data.time)


class TwinBackend:
    """A twin behind the joint-command interface.

    Args:
        twin: The twin.
        paced: See `TwinClock`.
        sensor_delay: Age of everything that is read, s; the robot's own by default.
        true_base: Put the true base state into observations.
        imu_errors: What the IMU makes of the motion; by default it is perfect.
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
        """Nothing to open."""

    def configure(self) -> None:
        """Nothing to assert: the twin is built from the same file."""

    def disconnect(self) -> None:
        """Nothing to close."""

    def request(self) -> None:
        """Nothing to ask for: the twin answers at once."""

    def collect(self) -> Observation:
        """Return the present state, as the sensors see it."""
        return self.sensors.read()

    def read(self) -> Observation:
        """Return the present state, as the sensors see it."""
        return self.sensors.read()

    def write(self, command: JointCommand) -> JointCommand:
        """Send a command; it acts after the twin's delay. Returns what the joints really got."""
        return self._drive.write(command, self._ctrl)

    def set_torque(self, on: bool) -> TorqueState:
        """Switch all actuators and return what became of it."""
        self.twin.powered = on
        return TorqueState.known(np.full(len(self.joints), self.twin.powered))
