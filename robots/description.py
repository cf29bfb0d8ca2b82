"""Description of a robot for the rest of the stack, from its checked robot.toml and model.xml."""

import os
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path

import mujoco
from msgspec.structs import replace

from windup.hal.config import load_toml
from windup.hal.contacts import ContactSensors
from windup.hal.errors import UnknownNameError, UsageError
from windup.hal.families import servo_model
from windup.hal.guard import HealthLevels, StopPolicy
from windup.hal.imu.kind import ImuKind
from windup.hal.joints import Array, Joint, Joints
from windup.hal.mirror import Mirror
from windup.hal.servos.servo_model import ServoMount
from windup.robots import mjcf, structure
from windup.robots.checks import Checks, whole_steps
from windup.robots.completion import complete, complete_for
from windup.robots.folders import FILE, RobotCache, gait_files, named_folder, robot_names
from windup.robots.imu import imu_of
from windup.robots.limits import with_limits
from windup.robots.mirror import mirror_map
from windup.robots.records import (
    Bus,
    CouplingEntry,
    Drive,
    Fall,
    Foot,
    Imu,
    JointEntry,
    RobotFile,
    Safety,
    with_defaults,
)

NEVER = Fall(height=1e-9, tilt=4.0)
"""Fall criterion of a robot with a fixed base, which is never met."""
_loaded: "RobotCache[RobotDescription]" = RobotCache()


@dataclass(frozen=True, eq=False)
class RobotDescription:
    """All constant data of a robot. Arrays are (n,) in MJCF order.

    Attributes:
        folder: Folder of its files.
        name: Name of the robot.
        title: Display name.
        sources: Sources of the numbers.
        model_path: Path of the MJCF.
        timestep: Physics step of the MJCF, s.
        rate_hz: Rate of the control loop, Hz.
        wire_rate_hz: Rate of the control loop on a servo bus, Hz.
        model_latency: Time from the start of a step until its plan applies, on the wall clock, s.
        base: Body with the free joint; of a `fixed` robot, a body that never moves.
        fixed: The base is fixed to the world, as of an arm.
        passive: Joints of the MJCF without a servo.
        couplings: Couplings by which robot.toml lets passive joints follow others.
        torso: Body whose z axis is the robot's "up".
        joints: The joints.
        axes: (n, 3) joint axes in the base frame, zero pose.
        servos: The servo of each joint; None for ideal torque joints.
        drive: Kind of actuators, and their latencies.
        buses: The servo buses.
        feet: The feet, left before right by custom.
        contacts: The contact sensors, grouped by foot.
        imu: The IMU, or None.
        poses: Pose name to (n,) rad.
        stance: (n,) pose to stand in, rad.
        crouch: (n,) pose to crouch in, rad, or None.
        stop: Stop policy: hold, crouch or limp.
        safety: Time-outs and levels of the `[safety]` table.
        fall: Criterion for a fallen robot, and protective falls.
        model: The compiled MJCF with its sensors. It is shared: copy it to change it.
    """

    folder: Path
    name: str
    title: str
    sources: tuple[str, ...]
    model_path: Path
    timestep: float
    rate_hz: float
    wire_rate_hz: float
    model_latency: float
    base: str
    fixed: bool
    passive: tuple[str, ...]
    couplings: tuple[CouplingEntry, ...]
    torso: str
    joints: Joints
    axes: Array
    servos: tuple[ServoMount | None, ...]
    drive: Drive
    buses: tuple[Bus, ...]
    feet: tuple[Foot, ...]
    contacts: ContactSensors
    imu: Imu | None
    poses: dict[str, Array]
    stance: Array
    crouch: Array | None
    stop: StopPolicy
    safety: Safety
    fall: Fall
    model: mujoco.MjModel = field(repr=False)

    @cached_property
    def mirror(self) -> Mirror:
        """Map that mirrors joint positions left to right.

        Raises:
            ConfigError: The robot is not symmetric.
        """
        return mirror_map(self.joints.names, self.axes)

    @cached_property
    def imu_kind(self) -> ImuKind | None:
        """Kind of its IMU with the mounting in this robot, or None."""
        return imu_of(self.imu, self.buses)

    @cached_property
    def health(self) -> HealthLevels:
        """Warning and stop levels of the joints' health."""
        return HealthLevels.of(self.servos, self.drive.supply, self.safety.configured())

    def spec(self) -> mujoco.MjSpec:
        """Return a new parse of the MJCF, completed with sensors; callers may change it."""
        spec = mjcf.parse_mjcf(self.model_path)
        complete(spec, self.base, self.imu, self.feet, self.couplings)
        return spec

    def gaits(self) -> dict[str, Path]:
        """Return the paths of the robot's gait files by name."""
        return gait_files(self.folder)

    def physics_steps(self, rate_hz: float | None = None) -> int:
        """Return the physics steps per tick at `rate_hz` (by default the robot's own rate).

        Raises:
            UsageError: The period is not a whole number of physics steps.
        """
        rate = self.rate_hz if rate_hz is None else rate_hz
        steps = whole_steps(rate, self.timestep) if rate > 0.0 else None
        if steps is None:
            raise UsageError(
                f"a rate of {rate:g} Hz is not a whole number of physics steps of "
                f"{1e3 * self.timestep:g} ms; {self.rate_hz:g} Hz is"
            )
        return steps


def load_robot(name_or_path: str | Path) -> RobotDescription:
    """Return a robot by its name, or by the path of a folder.

    A robot whose files have not changed since is the same object as before.

    Raises:
        UnknownNameError: There is neither such a robot nor such a folder.
        PluginError: Another distribution adds the robot, and its entry point is broken.
        ConfigError: A file of the robot cannot be read or failed a check.
    """
    folder = folder_of(name_or_path)
    if (known := _loaded.get(folder)) is not None:
        return known
    robot = _load(folder)
    if mjcf.is_self_contained(robot.model_path):
        _loaded.put(folder, (folder / FILE, robot.model_path), robot)
    return robot


def _load(folder: Path) -> RobotDescription:
    """Return the robot in a folder, read anew."""
    path = folder / FILE
    robot = with_drive_defaults(load_toml(path, RobotFile))
    model = mjcf.compile_mjcf(folder / robot.model, partial(complete_for, robot))
    robot = with_mjcf_limits(robot, model)
    Checks(path, robot, model).run()
    return describe(folder, robot, model)


def with_drive_defaults(robot: RobotFile) -> RobotFile:
    """Return a robot.toml with the defaults of `[drive]` filled in for each joint."""
    return replace(robot, joint=tuple(with_defaults(joint, robot.drive) for joint in robot.joint))


def with_mjcf_limits(robot: RobotFile, model: mujoco.MjModel) -> RobotFile:
    """Return a robot.toml with omitted joint limits filled in from the MJCF."""
    return replace(robot, joint=tuple(with_limits(joint, model) for joint in robot.joint))


def folder_of(name_or_path: str | Path) -> Path:
    """Return the folder of a robot by its name, Windup's own first, or by its path.

    Raises:
        UnknownNameError: There is neither such a robot nor such a folder.
        PluginError: Another distribution adds the robot, and its entry point is broken.
    """
    if (named := named_folder(str(name_or_path))) is not None:
        return named
    if os.path.isdir(name_or_path):  # False without an error even for an invalid path
        return Path(name_or_path)
    raise UnknownNameError("robot", str(name_or_path), robot_names())


def describe(folder: Path, robot: RobotFile, model: mujoco.MjModel) -> RobotDescription:
    """Return the description of a robot that has passed all `Checks`."""
    entries = {entry.name: entry for entry in robot.joint}
    ordered = [entries[name] for name in mjcf.hinge_names(model) if name in entries]
    servos = tuple(_mount(entry) for entry in ordered)
    pairs = zip(ordered, servos, strict=True)
    joints = Joints(tuple(_joint(entry, servo, robot.drive) for entry, servo in pairs))
    poses = {name: _frozen(joints.array(angles)) for name, angles in robot.poses.items()}
    return RobotDescription(
        folder=folder,
        name=robot.name,
        title=robot.title,
        sources=robot.sources,
        model_path=folder / robot.model,
        timestep=model.opt.timestep,
        rate_hz=robot.rate_hz,
        wire_rate_hz=robot.wire_rate_hz or robot.rate_hz,
        model_latency=robot.model_latency,
        base=robot.base,
        fixed=structure.is_fixed(model),
        passive=robot.joints_without_servo,
        couplings=robot.coupling,
        torso=robot.torso,
        joints=joints,
        axes=_frozen(mjcf.hinge_axes(model, joints.names)),
        servos=servos,
        drive=robot.drive,
        buses=robot.bus,
        feet=tuple(entry.foot() for entry in robot.foot),
        contacts=_contacts(robot),
        imu=robot.imu,
        poses=poses,
        stance=poses[robot.stance],
        crouch=poses[robot.crouch] if robot.crouch else None,
        stop=robot.stop,
        safety=robot.safety,
        fall=robot.fall or NEVER,
        model=model,
    )


def _mount(entry: JointEntry) -> ServoMount | None:
    """Return the servo of a joint, or None; `Checks` has verified that the entry is complete."""
    if entry.servo is None or entry.bus is None or entry.id is None:
        return None
    model = servo_model(entry.servo)
    zero = model.middle if entry.zero is None else entry.zero
    return ServoMount(
        model,
        entry.bus,
        entry.id,
        entry.sign,
        zero,
        entry.ratio,
        entry.offset,
        entry.mode == "extended",
    )


def _joint(entry: JointEntry, servo: ServoMount | None, drive: Drive) -> Joint:
    """Return a joint; torque and velocity that its entry omits are the maxima of its servo."""
    torque = velocity = goal_speed = float("inf")
    if servo is not None:
        motor = servo.model.motor(drive.supply)
        torque = motor.stall_torque * servo.ratio
        velocity = motor.no_load_speed / servo.ratio
        goal_speed = servo.model.goal_speed / servo.ratio
    return Joint(
        name=entry.name,
        lower=entry.lower,
        upper=entry.upper,
        stiffness=entry.stiffness or 0.0,
        damping=entry.damping or 0.0,
        torque=torque if entry.torque is None else entry.torque,
        velocity=velocity if entry.velocity is None else entry.velocity,
        goal_speed=goal_speed,
    )


def _contacts(robot: RobotFile) -> ContactSensors:
    feet = [entry.foot() for entry in robot.foot]
    names = tuple(name for foot in feet for name in foot.sensors)
    sensors, sides = {foot.name: foot.sensors for foot in feet}, tuple(foot.side for foot in feet)
    return ContactSensors(names, sensors, robot.contact_threshold, sides)


def _frozen(values: Array) -> Array:
    values.setflags(write=False)
    return values
