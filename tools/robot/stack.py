"""The lower half of a robot: a guarded backend, on a twin or on a port of servos."""

import logging
from dataclasses import dataclass
from typing import Literal

import windup.sim_twin.wire as wire
from windup.control.loop import Estimator
from windup.hal.errors import UsageError
from windup.hal.guard import GuardedBackend, HealthWatch, SafetyLimits
from windup.hal.imu.opencr import OpenCr
from windup.hal.imu.source import ImuSource
from windup.hal.servo_bus.servo_backend import BusPort, ServoBackend
from windup.hal.torque_state import TorqueState
from windup.robots import RobotDescription
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.environment import Environment
from windup.sim_twin.imu_errors import ImuErrors, imu_on_twin
from windup.sim_twin.sensors import Sensors
from windup.sim_twin.twin import Twin
from windup.sim_twin.twin_state_source import TwinStateSource
from windup.tools.assembly.build import build_estimator
from windup.tools.assembly.shape import can_estimate
from windup.tools.robot.port_urls import (
    IMU,
    TWIN,
    begin_noisily,
    forget_world,
    has_own_connection,
    in_a_world,
    port_urls,
    twin_behind,
)

State = Literal["true", "estimated"]


@dataclass(frozen=True)
class Stack:
    """A guarded backend and what belongs to it.

    Attributes:
        backend: The guarded backend, connected and configured; nothing has moved.
        twin: The twin behind it, or None on a robot.
        estimator: Fills in the base state, or None where the backend knows it.
        delay: From a state being measured to a command for it acting, s.
        wired: There is a port with servos between us and the joints.
        may_arm: Torque may be switched on.
        world: Name of the emulated world to forget at the end, or "".
        port: URL of the port, as the user gave it.
    """

    backend: GuardedBackend
    twin: Twin | None
    estimator: Estimator | None
    delay: float
    wired: bool = False
    may_arm: bool = True
    world: str = ""
    port: str | None = None

    @property
    def real(self) -> bool:
        """Is the port of the outer world? There may be an emulator of another program behind it."""
        return self.wired and not self.world

    def close(self) -> None:
        """Disconnect."""
        self.backend.disconnect()
        if self.world:
            wire.unregister_world(self.world)


def open_stack(
    robot: RobotDescription,
    port: str | None,
    *,
    state: State | None,
    arm: bool,
    paced: bool,
    delay: float | None,
    noise: float,
    seed: int,
    world: Environment | None,
) -> Stack:
    """Return a stack on the robot's twin, or on a port where one is given; see those.

    Raises:
        WindupError: It cannot be.
    """
    if port is not None:
        return wire_stack(robot, port, state=state, arm=arm, noise=noise, seed=seed, around=world)
    return twin_stack(
        robot,
        state=state or "true",
        paced=paced,
        delay=delay,
        noise=noise,
        seed=seed,
        world=world,
    )


def twin_stack(
    robot: RobotDescription,
    *,
    state: State,
    paced: bool,
    delay: float | None,
    noise: float,
    seed: int,
    world: Environment | None = None,
) -> Stack:
    """Return a stack on a twin of `robot`; where its state is estimated, its IMU is a real one.

    What is odd about the twin's `world` nobody is told.

    Raises:
        UsageError: The delay is not a whole number of physics steps.
    """
    _check_delay(delay, robot)
    twin = Twin(robot, delay=delay, world=world)
    twin.reset(noise=noise, seed=seed)
    true = state == "true"
    felt = imu_on_twin(robot)
    errors = None if true else ImuErrors(felt, twin.timestep, seed)
    estimator = None if true else build_estimator(robot, felt.lag)
    backend = _guarded(TwinBackend(twin, paced=paced, true_base=true, imu_errors=errors), robot)
    delay = robot.drive.command_delay if delay is None else delay
    return Stack(backend, twin, estimator, delay + robot.drive.sensor_delay)


def wire_stack(
    robot: RobotDescription,
    port: str,
    *,
    state: State | None,
    arm: bool,
    noise: float,
    seed: int,
    around: Environment | None = None,
) -> Stack:
    """Return a stack on a port with the servos of `robot`.

    Args:
        robot: The robot.
        port: URL of its bus, or "BUS=URL,BUS=URL" for several.
        state: Where the base state comes from; the truth is there behind twin:// only. By default
            it is estimated, where the robot has the sensors.
        arm: Torque may be switched on. It always may on a twin:// port.
        noise: Noise of the pose that an emulated robot begins in, degrees.
        seed: Seed of that noise.
        around: Ground and plant of an emulated robot.

    Raises:
        UsageError: The port does not fit the robot, or has no ground or plant of ours.
        HardwareError: Something on the bus is not as the robot's file says.
    """
    given, emulated = port, port.startswith(TWIN)
    world = ""
    if emulated:
        port, world = in_a_world(robot, port, around)
    elif around is not None:
        raise UsageError("only a twin has another ground or plant; leave --port away")
    servos = servo_backend(robot, port)
    backend = _guarded(servos, robot, given)
    try:
        backend.connect()
        twin = twin_behind(world) if emulated else None
        estimator = _estimator(robot, twin, state)
        if twin is not None:
            begin_noisily(world, twin, noise, seed)
        backend.configure()
    except BaseException:
        backend.disconnect()
        forget_world(world, given)
        raise
    delay = robot.drive.wire_delay
    return Stack(backend, twin, estimator, delay, True, arm or emulated, world, given)


def _estimator(robot: RobotDescription, twin: Twin | None, state: State | None) -> Estimator | None:
    """Return what fills in the base state behind a port; no servo bus carries foot switches."""
    if state is None and not can_estimate(robot):
        if not robot.fixed:
            logging.getLogger(__name__).warning(
                "nothing tells whether %s falls: that takes an [imu] and a [[foot]]", robot.name
            )
        return None
    if state != "true":
        kind = robot.imu_kind
        return build_estimator(
            robot,
            0.0 if kind is None else kind.lag,
            switches=False,
            attitude=kind is not None and not kind.gyroscope,
            apart=has_own_connection(kind),
        )
    if twin is None:
        raise UsageError("--state true needs a twin; a robot has `--state estimated`")
    return TwinStateSource(Sensors(twin))


def torque_off(robot: RobotDescription, port: str) -> TorqueState:
    """Switch all torque of `robot` off, whatever state it is in; return what was read back."""
    given, world = port, ""
    if port.startswith(TWIN):
        port, world = in_a_world(robot, port)
    backend = servo_backend(robot, port)
    try:
        backend.connect()
        return backend.set_torque(False)
    finally:
        backend.disconnect()
        forget_world(world, given)


def servo_backend(robot: RobotDescription, port: str) -> ServoBackend:
    """Return the servos of `robot` on a port, not yet connected.

    Raises:
        UsageError: The port does not fit the robot.
    """
    mounts = [servo for servo in robot.servos if servo is not None]
    if len(mounts) < len(robot.joints):
        raise UsageError(f"{robot.name} has no servos on a wire; leave --port away")
    bauds = {bus.name: bus.baud for bus in robot.buses}
    urls = port_urls(robot, port)
    board, imu = _imu(robot, urls.pop(IMU, None))
    return ServoBackend(
        robot.joints,
        mounts,
        {name: BusPort(url, bauds[name]) for name, url in urls.items()},
        supply=robot.drive.supply,
        board=board,
        imu=imu,
        contacts=len(robot.contacts.names),
    )


def _imu(robot: RobotDescription, url: str | None) -> tuple[OpenCr | None, ImuSource | None]:
    """Return the driver of the robot's IMU: a board's, or one with a connection at `url`."""
    kind = robot.imu_kind
    if kind is None or not has_own_connection(kind):
        return (None if kind is None else OpenCr(robot.buses[0].name, mounting=kind.mounting)), None
    if url is None or kind.driver is None:
        return None, None
    return None, kind.driver(url, kind.mounting)


def _guarded(
    backend: TwinBackend | ServoBackend, robot: RobotDescription, port: str | None = None
) -> GuardedBackend:
    limits, watch = SafetyLimits.of(robot.joints), None
    if any(robot.servos):
        watch = HealthWatch(robot.joints, robot.health, look_with(robot, port))
    return GuardedBackend(backend, limits, robot.stop, robot.crouch, watch)


def look_with(robot: RobotDescription, port: str | None) -> str:
    """Return what ends a message about an unwell robot: the command that shows more."""
    where = f" --port '{port}'" if port else ""
    return f"; look with `windup health {robot.name}{where}`"


def _check_delay(delay: float | None, robot: RobotDescription) -> None:
    if delay is None:
        return
    steps = delay / robot.timestep
    if abs(steps - round(steps)) > 1e-6:
        raise UsageError(
            f"--delay {delay:g}: give a whole number of physics steps of {robot.timestep:g} s"
        )
