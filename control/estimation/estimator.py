"""Estimation of the base state from the robot's sensors: IMU, encoders, contacts.

The IMU is integrated from tick to tick. The soles that bear the weight give, through the encoders,
the velocity of the base relative to the ground (leg odometry); a Kalman filter fuses both, and
corrects tilt and gyro bias by their difference. The yaw is the integral of the gyro, whose bias
about the vertical is measured while a sole does not turn. The lowest point of the soles is placed
exactly on a flat floor: rollouts start from this state, and a sole below the floor would be
pushed out of it. The horizontal position is the integral of the velocity.
"""

import mujoco
import numpy as np

from windup.control.estimation.foot_load import FootLoad
from windup.control.estimation.fused_attitude import FusedAttitude
from windup.control.estimation.height_filter import HeightFilter
from windup.control.estimation.leg_odometry import FootNoise, leg_odometry
from windup.control.estimation.tilt_filter import ImuNoise, TiltFilter
from windup.control.kinematics.soles import spin
from windup.hal.errors import StateMissingError
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array
from windup.hal.observation import BaseState, ImuState, Observation

STALE = 0.02  # age of an IMU sample, relative to the joints', that doubles its noise, s
LONGEST = 0.1  # maximum time integrated with one sample, s
PATIENCE = 0.25  # time without foot contact that halves the confidence, s
AIRBORNE = 1.0  # standard deviation of the velocity after a long time without contact, m/s
LYING = 0.5  # minimum cosine of the tilt for the soles to count as bearing weight
STILL = 1.0  # maximum deviation of an accelerometer at rest from gravity, m/s2
TILT, VELOCITY = 0.09, 0.2  # standard deviations that each halve the confidence, rad and m/s


class BaseEstimator:
    """Fills in `Observation.base`, and `contacts` if the robot has no contact sensors.

    The estimate is for the time of the joint samples. IMU samples that are older, or low-pass
    filtered, are extrapolated by that delay; for a first-order filter this is exact.

    Args:
        load: Distribution of the weight over the soles.
        imu: (3,) position of the IMU in the base frame, m; its axes are the base's.
        lag: Delay of the IMU's own low-pass filter, s.
        noise: Noise model of the IMU.
        feet: Noise model of the feet.
        fused: The IMU measures its attitude instead of rates; its rates are differences, which
            lag by half the time between two samples.
        read: Additional age of the joint samples beyond `age`, s.
    """

    def __init__(
        self,
        load: FootLoad,
        imu: Array,
        *,
        lag: float = 0.0,
        noise: ImuNoise | None = None,
        feet: FootNoise | None = None,
        fused: bool = False,
        read: float = 0.0,
    ) -> None:
        self.load, self.soles, self.lag, self.read = load, load.soles, lag, read
        self._fused = FusedAttitude() if fused else None
        self._imu, self._feet = imu, feet or FootNoise()
        self._filter = TiltFilter(noise)
        self.reset()

    def reset(self) -> None:
        """Start over at the next observation; the estimate of the gyro's bias is kept."""
        self._last: tuple[float, float, float, ImuState] | None = None
        self._height = HeightFilter()
        if self._fused is not None:
            self._fused.reset()
        self._position = np.zeros(3)
        self._airborne = 0.0

    @property
    def gyro_bias(self) -> Array:
        """(3,) estimated bias of the gyro in the base frame, rad/s."""
        return self._filter.bias

    def update(self, observation: Observation, dt: float) -> Observation:
        """Return `observation` with its base, and with contacts.

        Times and ages are taken from the observation, so that late or lost ticks have no effect.

        Raises:
            StateMissingError: The observation has no IMU.
        """
        imu, joints = observation.imu, observation.joints
        if imu is None:
            raise StateMissingError(
                "the base cannot be estimated without an IMU; give the robot one in robot.toml"
            )
        youngest = float(joints.age.min())
        passed, rate = self._carry(observation.time, youngest, imu)
        position = joints.position + (joints.age - youngest) * joints.velocity
        self.soles.update(position, joints.velocity, self._filter.frame[2])
        rate = rate - self._filter.bias
        shares = self._stand(observation.contacts, imu, rate, passed)
        base = self._base(rate, bool(shares.any()), passed)
        sensed = self.load.sensed(observation.contacts)
        contacts = observation.contacts if sensed else self.load.forces(shares)
        return Observation(observation.time, joints, imu, contacts, base)

    def _carry(self, time: float, youngest: float, imu: ImuState) -> tuple[float, Array]:
        """Integrate the IMU; return the time between joint samples, s, and the rate (3,), rad/s."""
        lead = min(imu.age - youngest - self.read, LONGEST) + self.lag
        last = self._last
        if last is None or time < last[0]:
            self.reset()
            self._filter.start(_upright(imu))
            self._last = (time, youngest, lead, imu)
            if self._fused is not None:
                self._fused.follow(imu, time - imu.age, time - youngest - self.read)
            return 0.0, imu.angular_velocity
        self._last = (time, youngest, lead, imu)
        passed = min(time - last[0] + last[1] - youngest, LONGEST)
        if passed <= 0.0:
            return 0.0, imu.angular_velocity
        before, old = last[2], last[3]
        # Trapezoidal rule between two samples; each sample is held constant over its lead.
        half = 0.5 * (passed - lead + before)
        now, then = half + lead, half - before
        rate = imu.angular_velocity
        if self._fused is not None:
            turn, rate = self._fused.follow(imu, time - imu.age, time - youngest - self.read)
        else:
            turn = now * rate + then * old.angular_velocity
            ahead = min(self.lag / passed, 1.0)
            rate = (1.0 + ahead) * rate - ahead * old.angular_velocity
        boost = now * imu.acceleration + then * old.acceleration
        self._filter.predict(turn, boost, passed, 1.0 + max(lead - self.lag, 0.0) / STALE)
        return passed, rate

    def _stand(self, contacts: Array, imu: ImuState, rate: Array, passed: float) -> Array:
        """Correct the filter by leg odometry; return (p,) the points' shares of the weight."""
        shares = self.load.shares(contacts, imu.acceleration)
        if self._filter.frame[2, 2] < LYING:
            shares = np.zeros_like(shares)
        seen = leg_odometry(self.soles, shares, rate, self._imu, self._feet)
        if seen is not None:
            self._airborne = 0.0
            self._filter.measure_velocity(self._filter.frame @ seen.velocity, seen.deviation)
            self._filter.measure_yaw_bias(imu.angular_velocity - seen.rate, seen.rate_deviation)
        else:
            self._airborne += passed
            if self._airborne > PATIENCE:
                self._filter.measure_velocity(np.zeros(3), AIRBORNE)
        if self._fused is not None and imu.orientation is not None:
            frame = np.empty(9)
            mujoco.mju_quat2Mat(frame, imu.orientation)
            self._filter.measure_up(frame[6:])
        return shares

    def _base(self, rate: Array, standing: bool, passed: float) -> BaseState:
        state, soles = self._filter, self.soles
        offset = state.frame @ (spin(rate) @ self._imu)
        lowest = -float((soles.position @ state.frame[2]).min())
        up = float(state.velocity[2] - offset[2])
        if standing:
            corrected = self._height.measure(lowest, up, passed)
            state.velocity[2] += corrected - up
            height = lowest
        else:
            height = self._height.fly(lowest, up, passed)
        velocity = state.velocity - offset
        self._position = self._position + velocity * passed
        self._position[2] = height
        return BaseState(
            self._position, state.orientation.copy(), velocity, rate, self._confidence()
        )

    def _confidence(self) -> float:
        tilt, velocity = self._filter.deviation
        known = 1.0 / (1.0 + (tilt / TILT) ** 2 + (velocity / VELOCITY) ** 2)
        return known * 0.5 ** (self._airborne / PATIENCE)


def _upright(imu: ImuState) -> Array:
    """Return the vertical (3,) by the accelerometer; the base's z axis if it is not at rest."""
    felt = float(np.linalg.norm(imu.acceleration))
    if abs(felt - GRAVITY) > STILL:
        return np.array([0.0, 0.0, 1.0])
    return imu.acceleration / felt
