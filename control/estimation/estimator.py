"""The base state from what a robot can measure: IMU, encoders, contacts.

The IMU carries the state from tick to tick. Whichever soles bear the weight say, through the
encoders, how fast the base moves over the ground; a Kalman filter weighs both, and finds tilt and
gyro bias by their difference. The yaw is the integral of the gyro, whose bias about the vertical
is found while a sole does not turn. The lowest point of the soles touches a flat floor, exactly:
rollouts begin from here, and a sole under the floor would kick them off it. The position is the
integral of the velocity.
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

STALE = 0.02  # age of an IMU sample, beside the joints', that doubles its noise, s
LONGEST = 0.1  # longest time bridged with one sample, s
PATIENCE = 0.25  # time without a foot down that halves the confidence, s
AIRBORNE = 1.0  # standard deviation of the velocity of a robot long without a foot down, m/s
LYING = 0.5  # cosine of the tilt past which a robot does not stand, whatever its soles touch
STILL = 1.0  # how far from gravity an accelerometer at rest may be, m/s2
TILT, VELOCITY = 0.09, 0.2  # deviations that each halve the confidence, rad and m/s


class BaseEstimator:
    """Fills in `Observation.base`, and `contacts` where the robot has no sensors for them.

    The estimate is for the instant at which the joints were read. IMU samples that are older, or
    come through a low-pass filter, are led by as much: for a filter of first order that is exact.

    Args:
        load: Who bears the weight, and the soles.
        imu: (3,) m, place of the IMU in the base; its axes are the base's.
        lag: Delay of the IMU's own low-pass filter, s.
        noise: What is believed about the IMU.
        feet: What is believed about the feet.
        fused: The IMU tells its attitude instead of rates; those it has are differences, half
            the time between two samples late.
        read: How much older than their age the joints' samples are, s.
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
        """Begin anew at the next observation; what is known of the gyro's bias stays."""
        self._last: tuple[float, float, float, ImuState] | None = None
        self._height = HeightFilter()
        if self._fused is not None:
            self._fused.reset()
        self._position = np.zeros(3)
        self._airborne = 0.0

    @property
    def gyro_bias(self) -> Array:
        """(3,) rad/s that the gyro shows too much, in the base."""
        return self._filter.bias

    def update(self, observation: Observation, dt: float) -> Observation:
        """Return `observation` with its base, and with contacts.

        Times and ages come from the observation, so that late and lost ticks do no harm.

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
        """Integrate the IMU; return the joints' time that has passed, s, and the gyro (3,)."""
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
        # Between two samples the trapezoid, and each sample held over its lead.
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
        """Let the soles correct the filter; return (p,) their shares of the weight."""
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
    """Return the vertical (3,) that a robot at rest feels, or the base's own in any other."""
    felt = float(np.linalg.norm(imu.acceleration))
    if abs(felt - GRAVITY) > STILL:
        return np.array([0.0, 0.0, 1.0])
    return imu.acceleration / felt
