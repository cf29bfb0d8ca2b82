"""Observations: the input of a controller each tick. SI units; quaternions wxyz, body to world."""

from dataclasses import dataclass

from windup.hal.joints import Array


@dataclass(frozen=True, slots=True)
class JointState:
    """State of the n joints in MJCF order; each attribute is an (n,) array.

    Attributes:
        position: Joint position, rad.
        velocity: Joint velocity, rad/s.
        torque: N m, from motor current; NaN if the servo does not measure current (its "load"
            register is not a torque).
        voltage: Supply voltage, V.
        temperature: Motor temperature, degrees C.
        age: Time since the servo last answered, s.
        health_age: Time since voltage and temperature were measured, s, if they are read less
            often than the rest; None if `age` applies to them too.
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
    """One IMU sample, rotated into the body frame.

    Attributes:
        orientation: (4,) wxyz, body to world, or None if the IMU does not estimate it.
        angular_velocity: (3,) rad/s in the body frame.
        acceleration: (3,) specific force, m/s2 in the body frame (at rest +9.81 upwards).
        age: Time since the sample was taken, s.
    """

    orientation: Array | None
    angular_velocity: Array
    acceleration: Array
    age: float


@dataclass(frozen=True, slots=True)
class BaseState:
    """Pose and velocity of the floating base.

    Attributes:
        position: (3,) m in the world frame.
        orientation: (4,) wxyz, body to world.
        linear_velocity: (3,) m/s in the world frame.
        angular_velocity: (3,) rad/s in the body frame.
        confidence: From 0 (unknown) to 1 (ground truth).
    """

    position: Array
    orientation: Array
    linear_velocity: Array
    angular_velocity: Array
    confidence: float = 1.0


@dataclass(frozen=True, slots=True)
class Observation:
    """All measurements of one instant.

    Attributes:
        time: Timestamp of the measurement on the backend's clock, s.
        joints: State of the joints.
        imu: Sample of the IMU, or None.
        contacts: (k,) normal forces of the contact sensors, N; a switch reads 0 or its threshold.
        base: State of the floating base: ground truth on a twin, estimate on a robot, or None.
    """

    time: float
    joints: JointState
    imu: ImuState | None
    contacts: Array
    base: BaseState | None
