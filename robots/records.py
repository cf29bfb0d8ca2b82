"""What `robot.toml` may say: one record a table, strict, SI units."""

from math import nan
from typing import Annotated, Literal

from msgspec import Meta
from msgspec.structs import replace

from windup.hal.config import Delay, Length, NotNegative, Positive, Record, Tilt
from windup.hal.guard import StopPolicy
from windup.hal.mirror import Side, side_of
from windup.robots.levels import JointLevels

GYRO, ACCELEROMETER = "gyro", "accelerometer"
"""Names of the sensors of an IMU that names none."""

Wait = Annotated[float, Meta(gt=0.0, le=86_400.0)]
Share = Annotated[float, Meta(ge=0.05, le=1.0)]


class Drive(Record, frozen=True):
    """What moves the joints.

    Attributes:
        kind: "servo" (position servos on a bus) or "torque" (ideal joints that obey the torque
            law at every physics step).
        supply: Voltage of the servos, V.
        command_delay: From a write to the joint acting on it, s.
        sensor_delay: From the joint moving to its state being read, s.
        wire_delay: From a state being measured to a command for it acting, on the bus, s.
        servo: Servo of the joints that name none.
        bus: Bus of the joints that name none.
        stiffness: Of the joints that state none, N m/rad.
        damping: Of the joints that state none, N m s/rad.
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


class Bus(Record, frozen=True):
    """A wire full of servos; its port is named when the robot is opened."""

    name: str
    protocol: Literal["dynamixel1", "dynamixel2", "feetech"]
    baud: Annotated[int, Meta(gt=0, le=10_000_000)]


class JointEntry(Record, frozen=True):
    """One joint: limits rad, gains N m/rad and N m s/rad, and the servo that drives it.

    What `servo`, `bus`, `stiffness` and `damping` leave out, the drive's defaults say.

    Attributes:
        lower: Smallest target, rad; by default the MJCF's.
        upper: Largest target, rad; by default the MJCF's.
        mode: How its servo counts: "position" is one turn; "extended" is 256 turns either way,
            which Dynamixel X servos have, and forget without power.
        torque: Largest torque, N m; by default the servo's at stall, or none.
        velocity: Largest velocity, rad/s; by default the servo's without load, or none.
        zero: Counts of the servo at joint angle 0; by default half a turn.
        ratio: Turns of the servo for one of the joint.
        offset: Counts that the servo holds in its own homing offset, which shifts all its counts.
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


class CouplingEntry(Record, frozen=True):
    """A joint without a servo that a linkage turns with another one, as URDF's <mimic> says.

    ``angle of joint = offset + ratio (angle of follows)``, kept by the twin as a constraint.

    Attributes:
        joint: The passive joint, a hinge or a slide of the MJCF.
        follows: The [[joint]] that moves it.
        ratio: rad (of a slide m) of it for one rad of the other.
        offset: Where it is while the other is at 0, rad (m).
    """

    joint: str
    follows: str
    ratio: Annotated[float, Meta(ge=-1_000.0, le=1_000.0)] = 1.0
    offset: Annotated[float, Meta(ge=-1_000.0, le=1_000.0)] = 0.0


class Foot(Record, frozen=True):
    """One foot.

    Attributes:
        name: Its name.
        body: Its body.
        site: The site at the centre of its sole.
        sensors: Its touch sensors in the MJCF.
        side: The side that it is on; "" where nothing says so.
    """

    name: str
    body: str
    site: str
    sensors: tuple[str, ...]
    side: Side | Literal[""] = ""


class FootEntry(Record, frozen=True):
    """A foot as the file has it: without `sensors` it gets one, without `side` its name tells."""

    name: str
    body: str
    site: str
    sensors: tuple[str, ...] | None = None
    side: Side | None = None

    def foot(self) -> Foot:
        """Return the foot."""
        sensors = (f"{self.name}_touch",) if self.sensors is None else self.sensors
        side = self.side or side_of(self.name)
        return Foot(name=self.name, body=self.body, site=self.site, sensors=sensors, side=side)


class Imu(Record, frozen=True):
    """The IMU: the site it sits at and the names of its sensors in the MJCF.

    A gyroscope and an accelerometer that the MJCF lacks are added, where the file names none.

    Attributes:
        site: A site whose axes are the base's.
        kind: What it is: opencr, bno08x_rvc, bno055 or open_duck. By default an OpenCR where the
            first bus has protocol "dynamixel2" or there is none, and a BNO08x elsewhere.
        mounting: The axes of the IMU that point along the base's x (forward), y (left) and z (up),
            such as ["-y", "x", "z"]; by default those of its kind.
        gyro: Name of a sensor in the MJCF.
        accelerometer: Name of a sensor in the MJCF.
        orientation: Name of a sensor in the MJCF, if it has one.
    """

    site: str
    kind: str | None = None
    mounting: tuple[str, str, str] | None = None
    gyro: str = GYRO
    accelerometer: str = ACCELEROMETER
    orientation: str | None = None


class Shares(Record, frozen=True):
    """Shares of the joints' stiffness: of those between base and feet, and of all others.

    None is small enough to leave a joint limp.
    """

    legs: Share
    others: Share


class FallWay(Record, frozen=True):
    """How to fall toward one side.

    Attributes:
        toward: Which side, rad from straight ahead, positive to the left.
        pose: Name of the pose to take.
        soften: Tilt of the base from which the impact is near, rad.
        falling: Stiffness until then.
        impact: Stiffness from then on.
    """

    toward: Annotated[float, Meta(ge=-4.0, le=4.0)]
    pose: str
    soften: Tilt
    falling: Shares
    impact: Shares


class Fall(Record, frozen=True):
    """When the robot counts as fallen: base lower than `height` m or torso past `tilt` rad.

    Attributes:
        reach: How far outside the hull of its soles it can put a foot, m; ways need it.
        way: How it falls when it must; without any it falls as it is.
    """

    height: Length
    tilt: Tilt
    reach: Length | None = None
    way: tuple[FallWay, ...] = ()


class Safety(JointLevels, frozen=True):
    """What keeps an armed robot safe: levels of its joints' health, and when nobody commands it.

    Attributes:
        idle: How long it is held between two calls of a program before its torque goes off, s.
        hold: How long the guardian holds a robot whose `stop` is "hold" once its program is gone,
            before its torque goes off, s.
        first_speed: Largest speed of a joint in the first motion after torque came on, rad/s.
        first_stiffness: Shares of the joints' stiffness that this motion begins with. Legs have to
            bear the robot.
        first_lag: How far a joint may be behind its goal in it, rad.
    """

    idle: Wait = 10.0
    hold: Wait = 60.0
    first_speed: Annotated[float, Meta(ge=0.01, le=50.0)] = 0.6
    first_stiffness: Shares = Shares(legs=0.6, others=0.3)
    first_lag: Tilt = 0.25


INHERITED = ("servo", "bus", "stiffness", "damping")


def with_defaults(entry: JointEntry, drive: Drive) -> JointEntry:
    """Return the joint with what it leaves out taken from the drive."""
    missing = [key for key in INHERITED if getattr(entry, key) is None]
    return replace(entry, **{key: getattr(drive, key) for key in missing})


class RobotFile(Record, frozen=True):
    """A whole `robot.toml`.

    Attributes:
        name: The robot's name, as its folder.
        title: Its name for people.
        sources: Where the numbers come from.
        model: The MJCF beside this file.
        rate_hz: Rate of the control loop, Hz.
        wire_rate_hz: Rate of the control loop on a servo bus, Hz; by default the same.
        base: Body with the free joint; of a robot that is fixed, such as an arm, the body that is.
        torso: Body whose z axis is the robot's "up".
        stop: What "stop" means: hold, crouch, or limp.
        stance: Name of the pose to stand in.
        crouch: Name of the pose to crouch in.
        model_latency: From the start of a step to its plan acting, where time is the wall's, s.
        contact_threshold: Force above which a contact sensor counts as pressed, N.
        passive: Joints of the MJCF that no servo moves: springs, casters, and what the MJCF's own
            <equality> couples.
        coupling: Passive joints that follow others, and how, where the MJCF does not say so.
        fall: When it counts as fallen; a robot that is fixed has none.
        poses: Pose name to joint name to rad; joints not named are at 0.
    """

    name: Annotated[str, Meta(min_length=1, max_length=64)]
    title: str
    rate_hz: Positive
    base: str
    torso: str
    stance: str
    drive: Drive
    joint: tuple[JointEntry, ...]
    poses: dict[str, dict[str, float]]
    wire_rate_hz: Positive | None = None
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
    def unmoved(self) -> tuple[str, ...]:
        """The joints of the MJCF that no servo moves, followers too."""
        followers = tuple(coupling.joint for coupling in self.coupling)
        return tuple(dict.fromkeys((*self.passive, *followers)))
