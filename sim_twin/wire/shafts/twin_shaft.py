"""Shafts that are the joints of the MuJoCo twin.

A servo's firmware changes the parameters of the joint's `dcmotor`; MuJoCo integrates the motor.
The controller of a dcmotor asks for a torque, ``kp (ctrl - q) - kd dq``, and drives the voltage
``u = R/K torque + K dq``, within ``Vmax`` (0: no limit). The four ways of driving are:

| | kp | kd | Vmax | ctrl |
|---|---|---|---|---|
| hold a goal | stiffness | K^2/R: cancels ``+ K dq`` | volts | goal |
| apply a voltage | anything | K^2/R | volts | far away, so that it saturates |
| produce a torque | next to nothing | 0 | volts | torque / kp |
| off | 0 | 0 | none | anything: u = K dq, no current |
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from weakref import WeakMethod

import numpy as np

from windup.hal.joints import Array, Mask
from windup.hal.servos.servo_model import ServoMount
from windup.sim_twin.imu_errors import LowPass
from windup.sim_twin.servo.servo_motor import KD, KP, VMAX
from windup.sim_twin.twin import Twin

FAR = 1e6  # goal that saturates the voltage, rad
SOFT = 1e-6  # stiffness of a commanded torque, N m/rad


class TwinShaft:
    """The horn of the servo at one joint of a twin.

    Args:
        twin: The twin; its command delay should be 0, because the bus has a delay of its own.
        joint: Index of the joint.
        mount: Mounting of the servo at the joint.

    Attributes:
        joint: Index of the joint.
        miswired: Whether the motor turns the wrong way and drives the joint away from its goal.
    """

    def __init__(self, twin: Twin, joint: int, mount: ServoMount) -> None:
        self._data, self.joint = twin.data, joint
        self._turn = mount.sign * mount.ratio  # horn angle per joint angle
        per_rad = mount.model.counts_per_rev / (2.0 * math.pi)
        self._zero = (mount.zero - mount.model.middle) / per_rad
        self._prm = twin.model.actuator_gainprm[joint]
        self._range = twin.model.actuator_forcerange[joint]
        self._limited = twin.model.actuator_forcelimited
        self._limit_open = True
        self.miswired = False
        self._factor = twin.world.plant.stiffness
        self._damping = mount.model.damping(twin.supply) * mount.ratio**2
        self._q, self._at = twin.data.qpos, int(twin.indices.qpos[joint])
        self._dq, self._dof = twin.data.qvel, int(twin.indices.dofs[joint])
        self._ctrl, self._force = twin.data.ctrl, twin.data.actuator_force

    @property
    def position(self) -> float:
        """See `Shaft`."""
        return self._turn * float(self._q[self._at]) + self._zero

    @property
    def velocity(self) -> float:
        """See `Shaft`."""
        return self._turn * float(self._dq[self._dof])

    @property
    def torque(self) -> float:
        """See `Shaft`."""
        return float(self._force[self.joint]) / self._turn

    def hold_goal(
        self, goal: float, stiffness: float, volts: float, torque: float = math.inf
    ) -> None:
        """See `Shaft`."""
        if volts <= 0.0:
            self.apply_voltage(0.0)
            return
        gain = -self._factor if self.miswired else self._factor
        self._set(gain * stiffness * self._turn**2, self._damping, volts, torque)
        self._ctrl[self.joint] = (goal - self._zero) / self._turn

    def apply_voltage(self, volts: float) -> None:
        """See `Shaft`."""
        if volts == 0.0:
            self._set(0.0, self._damping, 0.0)
        else:
            self._set(1.0, self._damping, abs(volts))
            self._ctrl[self.joint] = math.copysign(FAR, volts * self._turn)

    def apply_torque(self, torque: float, volts: float) -> None:
        """See `Shaft`."""
        if volts <= 0.0:
            self.apply_voltage(0.0)
            return
        self._set(SOFT, 0.0, volts)
        self._ctrl[self.joint] = torque * self._turn / SOFT

    def release(self) -> None:
        """See `Shaft`."""
        self._set(0.0, 0.0, 0.0)

    def _set(self, kp: float, kd: float, volts: float, torque: float = math.inf) -> None:
        prm = self._prm
        prm[KP], prm[KD], prm[VMAX] = kp, kd, volts
        open_ = torque == math.inf
        if not (open_ and self._limit_open):
            self._limited[self.joint] = not open_
            most = 0.0 if open_ else torque * abs(self._turn)
            self._range[:] = -most, most
            self._limit_open = open_


NOISE = 0.02
"""Noise of an accelerometer, m/s2: an MPU-9250 has 0.3 mg/rtHz (datasheet, table 2), over 50 Hz.
Without noise, the IMU of a robot that stands still would look frozen."""


class TwinImu:
    """The IMU of a twin with a low-pass filter; a source for `OpenCr` and `start_rvc`.

    Without the filter a host that samples at 125 Hz would miss half of every impact.

    Args:
        twin: The twin.
        lag: Time constant of the filter, s.

    Attributes:
        held: Returns whether the robot is held; it then reads as at rest, whatever the physics
            do to limp joints between two corrections of the pose.
    """

    silent = False

    def __init__(self, twin: Twin, lag: float) -> None:
        imu = twin.robot.imu
        if imu is None:
            raise ValueError(f"robot {twin.robot.name!r} has no IMU")
        gyro = int(twin.model.sensor(imu.gyro).adr[0])
        acceleration = int(twin.model.sensor(imu.accelerometer).adr[0])
        self.held: Callable[[], bool] = lambda: False
        self._data = twin.data.sensordata
        self._site = twin.data.site(imu.site).xmat.reshape(3, 3)
        self._gravity = -twin.model.opt.gravity
        self._places = np.r_[gyro : gyro + 3, acceleration : acceleration + 3]
        self._filter = LowPass(lag, twin.timestep)
        self._base = (
            twin.data.body(twin.robot.base).xquat if twin.robot.fixed else twin.data.qpos[3:7]
        )
        self._noise = np.random.default_rng(0).normal(0.0, NOISE, (1009, 3))
        self._steps = 0
        twin.on_step = _while_alive(self._feel)

    @property
    def angular_velocity(self) -> Array:
        """Angular velocity (3,), rad/s."""
        return self._filter.value(self._felt())[:3]

    @property
    def acceleration(self) -> Array:
        """Proper acceleration (3,), m/s2."""
        felt: Array = self._filter.value(self._felt())[3:]
        return felt + self._noise[self._steps % len(self._noise)]

    @property
    def orientation(self) -> Array:
        """Orientation (4,), wxyz quaternion from body to world."""
        return np.asarray(self._base)

    def _feel(self) -> None:
        self._steps += 1
        self._filter.update(self._felt())

    def _felt(self) -> Array:
        """Return angular velocity, rad/s, and acceleration, m/s2, (6,) before the filter."""
        if self.held():
            return np.concatenate([np.zeros(3), self._gravity @ self._site])
        return np.asarray(self._data[self._places])


@dataclass
class TwinPhysics:
    """The physics of a world that contains a twin.

    A robot without torque would fall before its host has connected, so it is held: the base, and
    each joint whose servo has not been driven yet, keep their pose until all servos have been
    driven once. From then on it is free, unless `hold_again` is set: then it is held again whenever
    no servo is driven, in its present pose or, if it has fallen, in its initial one.

    Attributes:
        twin: The twin.
        driven: (n,) bool: whether the servo of this joint has been driven.
        held: Whether the robot is held now.
        stays_held: Whether the base stays held for ever, whatever the servos do.
        hold_again: Whether the robot is held again when none of its servos is driven any more.
        jammed: (n,) bool: whether the joint is blocked.
        shafts: The horns of the servos.
    """

    twin: Twin
    held: bool = True
    stays_held: bool = False
    hold_again: bool = False
    shafts: Sequence[TwinShaft] = ()

    def __post_init__(self) -> None:
        self.timestep = self.twin.timestep
        self.driven = np.zeros(len(self.twin.robot.joints), dtype=bool)
        self.jammed = np.zeros_like(self.driven)
        self._qpos, self._qvel = self.twin.data.qpos.copy(), np.zeros(self.twin.model.nv)
        self._start = self._qpos.copy()

    def store_held_pose(self) -> None:
        """Record the present pose as the one to hold, with no servo driven yet."""
        self._qpos[:] = self.twin.data.qpos
        self.driven[:] = False

    def step(self) -> None:
        """Advance by one step."""
        if self.held or self.hold_again:
            prm = self.twin.model.actuator_gainprm
            driven = (prm[:, KP] != 0.0) | (prm[:, KD] != 0.0)
            self._hold_or_release(driven)
        self.twin.step(1)
        if self.held:
            self._hold()
        if self.jammed.any():
            self._jam()

    def turn(self, joint: int, angle: float, rate: float) -> None:
        """Set a joint to `angle` rad and `rate` rad/s, as turned by hand."""
        data, at = self.twin.data, self.twin.indices.qpos[joint]
        data.qpos[at] = self._qpos[at] = angle
        data.qvel[self.twin.indices.dofs[joint]] = rate

    def _hold_or_release(self, driven: Mask) -> None:
        """Release the robot when all servos have been driven; hold it again when it is limp."""
        if self.held:
            self.driven |= driven
            if self.driven.all() and not self.stays_held:
                self.held = False
        elif not driven.any():
            self.store_held_pose()
            if self.twin.fallen:
                self._qpos[:] = self._start
            self.held = True

    def _hold(self) -> None:
        """Restore the held base and joints to their pose."""
        data = self.twin.data
        free = np.flatnonzero(self.driven)
        at, dofs = self.twin.indices.qpos[free], self.twin.indices.dofs[free]
        kept_q, kept_v = data.qpos[at].copy(), data.qvel[dofs].copy()
        data.qpos[:], data.qvel[:] = self._qpos, self._qvel
        data.qpos[at], data.qvel[dofs] = kept_q, kept_v

    def _jam(self) -> None:
        """Restore the blocked joints to their position."""
        stuck = np.flatnonzero(self.jammed)
        at, dofs = self.twin.indices.qpos[stuck], self.twin.indices.dofs[stuck]
        self.twin.data.qpos[at] = self._qpos[at]
        self.twin.data.qvel[dofs] = 0.0


def _while_alive(method: Callable[[], None]) -> Callable[[], None]:
    """Return a function that calls a method while its object lives, without keeping it alive."""
    found = WeakMethod(method)

    def call() -> None:
        if (method := found()) is not None:
            method()

    return call
