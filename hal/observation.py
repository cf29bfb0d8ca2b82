"""What a controller is given each tick. SI units; quaternions wxyz, body to world."""

from dataclasses import dataclass

from windup.hal.joints import Array


@dataclass(frozen=True, slots=True)
class JointState:
    """State of the n joints in MJCF order; every attribute but None is an (n,) array.

    Attributes:
        position: rad.
        velocity: rad/s.
        torque: N m, from motor current; NaN where a servo measures none (a load is no torque).
        voltage: Supply, V.
        temperature: Motor, degrees C.
        age: Seconds since the servo last answered.
        health_age: Seconds since voltage and temperature were measured, which is less often; None
            where they are as young as the rest.
    """

    position: Array
    velocity: Array
    torque: Array
    voltage: Array
    temperature: Array
    age: Array
    health_age: Array | None = None


@dataclass(frozen=True, slots=True)
class ImuState:
    """One inertial sample, already turned into the body frame.

    Attributes:
        orientation: (4,) wxyz, body to world, or None where the IMU does not fuse one.
        angular_velocity: (3,) rad/s in the body.
        acceleration: (3,) m/s2 in the body, gravity included (a robot at rest reads +9.81 up).
        age: Seconds since the sample was taken.
    """

    orientation: Array | None
    angular_velocity: Array
    acceleration: Array
    age: float


@dataclass(frozen=True, slots=True)
class BaseState:
    """Pose and velocity of the floating base.

    Attributes:
        position: (3,) m in the world.
        orientation: (4,) wxyz, body to world.
        linear_velocity: (3,) m/s in the world.
        angular_velocity: (3,) rad/s in the body.
        confidence: 0 unknown to 1 true.
    """

    position: Array
    orientation: Array
    linear_velocity: Array
    angular_velocity: Array
    confidence: float = 1.0


@dataclass(frozen=True, slots=True)
class Observation:
    """Everything measured at one instant.

    Attributes:
        time: When it was measured, s on the backend's clock.
        joints: The joints.
        imu: The IMU, or None.
        contacts: (k,) normal forces of the contact sensors, N; a switch reads 0 or its threshold.
        base: The floating base: truth on a twin, an estimate on a robot, or None.
    """

    time: float
    joints: JointState
    imu: ImuState | None
    contacts: Array
    base: BaseState | None
