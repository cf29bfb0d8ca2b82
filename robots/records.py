"""Format of `robot.toml`: one strict record per table, SI units."""

from math import nan
from typing import Annotated, Literal

from msgspec import Meta
from msgspec.structs import replace

from windup.hal.config import Delay, Length, NotNegative, Positive, Tilt, TomlRecord
from windup.hal.guard import StopPolicy
from windup.hal.mirror import Side, side_of
from windup.robots.levels import JointLevels

GYRO, ACCELEROMETER = "gyro", "accelerometer"
"""Default names of the sensors of an IMU."""

LoopRate = Annotated[float, Meta(ge=1.0, le=10_000.0)]
Wait = Annotated[float, Meta(gt=0.0, le=86_400.0)]
Share = Annotated[float, Meta(ge=0.05, le=1.0)]


class Drive(TomlRecord, frozen=True):
    """Actuators of the joints, their latencies, and defaults of the joints.

    Attributes:
        kind: "servo" (position servos on a bus) or "torque" (ideal joints that follow the torque
            law at every physics step).
        supply: Supply voltage of the servos, V.
        command_delay: Latency from a write to the joint's reaction, s.
        sensor_delay: Latency from the joint's motion to the reading of its state, s.
        wire_delay: Latency from a measured state to the effect of its command, on the bus, s.
        servo: Default servo model of the joints.
        bus: Default bus of the joints.
        stiffness: Default stiffness of the joints, N m/rad.
        damping: Default damping of the joints, N m s/rad.
    """

    kind: Literal["servo", "torque"]
    supply: Annotated[float, Meta(gt=0.0, le=60.0)] = 12.0
    command_delay: Delay = 0.0
    sensor_delay: Delay = 0.0
    wire_delay: Delay = 0.0
    servo: str | None = None
    bus: str | None = None
    stiffness: NotNegative | None = None
    damping: NotNegative | None = None


class Bus(TomlRecord, frozen=True):
    """A servo bus; its serial port is given when the robot is opened.

    Attributes:
        protocol: "dynamixel1", "dynamixel2", "feetech", or that of a family that another
            distribution adds.
    """

    name: str
    protocol: Annotated[str, Meta(examples=["dynamixel1", "dynamixel2", "feetech"])]
    baud: Annotated[int, Meta(gt=0, le=10_000_000)]


class JointEntry(TomlRecord, frozen=True):
    """One joint: limits rad, gains N m/rad and N m s/rad, and the servo that drives it.

    Omitted `servo`, `bus`, `stiffness` and `damping` are the defaults of the drive.

    Attributes:
        lower: Minimum target, rad; by default the MJCF's.
        upper: Maximum target, rad; by default the MJCF's.
        mode: Operating mode of the servo: "position" is one turn; "extended" is 256 turns either
            way, which Dynamixel X servos have; they lose the turn count without power.
        torque: Maximum torque, N m; by default the servo's stall torque, or no limit.
        velocity: Maximum velocity, rad/s; by default the servo's no-load speed, or no limit.
        id: Id of the servo on its bus.
        sign: -1 if the servo turns opposite to the joint.
        zero: Counts of the servo at joint angle 0; by default the middle of its range.
        ratio: Gear ratio: turns of the servo per turn of the joint.
        offset: Homing offset stored in the servo, counts; it shifts all its positions.
    """

    name: str
    lower: float = nan
    upper: float = nan
    mode: Literal["position", "extended"] = "position"
    stiffness: NotNegative | None = None
    damping: NotNegative | None = None
    torque: Positive | None = None
    velocity: Positive | None = None
    servo: str | None = None
    bus: str | None = None
    id: Annotated[int, Meta(ge=0, le=253)] | None = None
    sign: Literal[1, -1] = 1
    zero: Annotated[int, Meta(ge=-1_048_575, le=1_048_575)] | None = None
    ratio: Annotated[float, Meta(gt=0.0, le=1_000.0)] = 1.0
    offset: Annotated[int, Meta(ge=-1_044_479, le=1_044_479)] = 0


class CouplingEntry(TomlRecord, frozen=True):
    """A joint without a servo that a linkage moves with another one, like URDF's <mimic>.

    ``angle of joint = offset + ratio (angle of follows)``, a constraint in the twin.

    Attributes:
        joint: The passive joint, a hinge or a slide of the MJCF.
        follows: The [[joint]] that moves it.
        ratio: Motion of `joint`, rad (m for a slide), per rad of `follows`.
        offset: Position of `joint`, rad (m for a slide), with `follows` at 0.
    """

    joint: str
    follows: str
    ratio: Annotated[float, Meta(ge=-1_000.0, le=1_000.0)] = 1.0
    offset: Annotated[float, Meta(ge=-1_000.0, le=1_000.0)] = 0.0


class Foot(TomlRecord, frozen=True):
    """One foot.

    Attributes:
        name: Name of the foot.
        body: Its body in the MJCF.
        site: The site at the centre of its sole.
        sensors: Its touch sensors in the MJCF.
        side: Its side; "" if that is unknown.
    """

    name: str
    body: str
    site: str
    sensors: tuple[str, ...]
    side: Side | Literal[""] = ""


class FootEntry(TomlRecord, frozen=True):
    """A foot in the file; by default it gets one sensor, and its side follows from its name."""

    name: str
    body: str
    site: str
    sensors: tuple[str, ...] | None = None
    side: Side | None = None

    def foot(self) -> Foot:
        """Return the foot with defaults filled in."""
        sensors = (f"{self.name}_touch",) if self.sensors is None else self.sensors
        side = self.side or side_of(self.name)
        return Foot(name=self.name, body=self.body, site=self.site, sensors=sensors, side=side)


class Imu(TomlRecord, frozen=True):
    """The IMU: its site and the names of its sensors in the MJCF.

    A gyroscope and an accelerometer of the default names are added if the MJCF lacks them.

    Attributes:
        site: A site whose axes are those of the base.
        kind: opencr, bno08x_rvc, bno055 or open_duck. The default is opencr if the first bus has
            protocol "dynamixel2" or there is no bus, else bno08x_rvc.
        mounting: The axes of the IMU that point along the base's x (forward), y (left) and z (up),
            such as ["-y", "x", "z"]; the default is that of the kind.
        gyro: Name of the gyroscope in the MJCF.
        accelerometer: Name of the accelerometer in the MJCF.
        orientation: Name of an orientation sensor in the MJCF, or None.
    """

    site: str
    kind: str | None = None
    mounting: tuple[str, str, str] | None = None
    gyro: str = GYRO
    accelerometer: str = ACCELEROMETER
    orientation: str | None = None


class StiffnessShares(TomlRecord, frozen=True):
    """Shares of the joints' stiffness: for joints between base and feet, and for all others.

    The minimum is large enough that no joint is limp.
    """

    legs: Share
    others: Share


class ProtectiveFallEntry(TomlRecord, frozen=True):
    """Pose and stiffness of a protective fall in one direction.

    Attributes:
        toward: Direction, rad from straight ahead, positive to the left.
        pose: Name of the landing pose.
        soften: Tilt of the base at which the joints are softened for the impact, rad.
        falling: Shares of the stiffness until then.
        impact: Shares of the stiffness from then on.
    """

    toward: Annotated[float, Meta(ge=-4.0, le=4.0)]
    pose: str
    soften: Tilt
    falling: StiffnessShares
    impact: StiffnessShares


class Fall(TomlRecord, frozen=True):
    """Criterion for a fallen robot: base lower than `height` m or torso tilted by over `tilt` rad.

    Attributes:
        reach: Maximum distance outside the hull of its soles at which it can put a foot, m;
            required with `way`.
        way: Protective falls; without any, falls are not predicted.
    """

    height: Length
    tilt: Tilt
    reach: Length | None = None
    way: tuple[ProtectiveFallEntry, ...] = ()


class Safety(JointLevels, frozen=True):
    """Safety of an armed robot: levels of its joints' health, time-outs, and the first motion.

    Attributes:
        idle: Maximum time between two calls of a program before torque is disabled, s.
        hold: Time for which the guardian holds a robot whose `stop` is "hold" after its program
            has ended, before torque is disabled, s.
        first_speed: Maximum speed of a joint in the first motion after torque enable, rad/s.
        first_stiffness: Shares of the joints' stiffness at the start of the first motion; those of
            the legs must be enough to bear the robot.
        first_lag: Maximum position error of a joint in the first motion, rad.
    """

    idle: Wait = 10.0
    hold: Wait = 60.0
    first_speed: Annotated[float, Meta(ge=0.01, le=50.0)] = 0.6
    first_stiffness: StiffnessShares = StiffnessShares(legs=0.6, others=0.3)
    first_lag: Tilt = 0.25


INHERITED = ("servo", "bus", "stiffness", "damping")


def with_defaults(entry: JointEntry, drive: Drive) -> JointEntry:
    """Return the joint with the drive's defaults for keys that it omits."""
    missing = [key for key in INHERITED if getattr(entry, key) is None]
    return replace(entry, **{key: getattr(drive, key) for key in missing})


class RobotFile(TomlRecord, frozen=True):
    """A whole `robot.toml`.

    Attributes:
        name: Name of the robot, as its folder.
        title: Display name.
        sources: Sources of the numbers.
        model: File name of the MJCF beside this file.
        rate_hz: Rate of the control loop, Hz.
        wire_rate_hz: Rate of the control loop on a servo bus, Hz; by default the same.
        base: Body with the free joint; of a fixed robot, such as an arm, a body fixed to the world.
        torso: Body whose z axis is the robot's "up".
        stop: Stop policy: hold, crouch, or limp.
        stance: Name of the pose to stand in.
        crouch: Name of the pose to crouch in.
        model_latency: Time from the start of a step until its plan applies, on the wall clock, s.
        contact_threshold: Force above which a contact sensor counts as pressed, N.
        passive: Joints of the MJCF without a servo: springs, casters, and joints that the MJCF's
            own <equality> couples.
        coupling: Passive joints that follow others, if the MJCF does not couple them.
        fall: Criterion for a fallen robot; a fixed robot has none.
        poses: Joint positions, rad, by pose and joint name; joints not named are at 0.
    """

    name: Annotated[str, Meta(min_length=1, max_length=64)]
    title: str
    rate_hz: LoopRate
    base: str
    torso: str
    stance: str
    drive: Drive
    joint: tuple[JointEntry, ...]
    poses: dict[str, dict[str, float]]
    wire_rate_hz: LoopRate | None = None
    stop: StopPolicy = "limp"
    model: str = "model.xml"
    crouch: str | None = None
    sources: tuple[str, ...] = ()
    bus: tuple[Bus, ...] = ()
    foot: tuple[FootEntry, ...] = ()
    passive: tuple[str, ...] = ()
    coupling: tuple[CouplingEntry, ...] = ()
    fall: Fall | None = None
    model_latency: Delay = 0.06
    contact_threshold: Positive = 1.0
    imu: Imu | None = None
    safety: Safety = Safety()

    @property
    def joints_without_servo(self) -> tuple[str, ...]:
        """The joints of the MJCF without a servo, including coupled ones."""
        followers = tuple(coupling.joint for coupling in self.coupling)
        return tuple(dict.fromkeys((*self.passive, *followers)))
