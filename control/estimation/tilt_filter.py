"""A Kalman filter for tilt, velocity and gyro bias, from an IMU and leg odometry.

The errors of a floating base obey, for a tilt error about one horizontal axis, the velocity error
along the other, and the gyro's bias about the first (g is gravity; signs as for pitch and x)::

    d tilt / dt = -bias        d velocity / dt = g tilt        d bias / dt = 0

and the velocity is measured. Both horizontal axes have the same noise, so one covariance (3, 3)
serves both. The filter is that of Bloesch 2012 ("State estimation for legged robots") reduced to
these states; the yaw is not measured, and not corrected. The accelerometer is not used as a
direction of the vertical but only integrated to a velocity, so that the accelerations of walking
cause no tilt error.
"""

from dataclasses import dataclass

import mujoco
import numpy as np

from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array


@dataclass(frozen=True)
class ImuNoise:
    """Noise model of the IMU; standard deviations, the first three per square root of hertz.

    Attributes:
        gyro: Angular rate, rad/s; sensor noise is small, most is the sampling error of fast motion.
        acceleration: Acceleration, m/s2; most is the sampling error of impacts.
        drift: Drift of the gyro's bias, rad/s2.
        start_tilt: Tilt at the start, rad.
        start_velocity: Velocity at the start, m/s.
        start_bias: Bias of the gyro at the start, rad/s.
        fused: Tilt of the IMU's own orientation, rad.
    """

    gyro: float = 2e-3
    acceleration: float = 0.05
    drift: float = 2e-4
    start_tilt: float = 0.035
    start_velocity: float = 0.1
    start_bias: float = 0.02
    fused: float = 0.05


class TiltFilter:
    """Estimates attitude and horizontal velocity at the IMU's position, and the gyro's bias.

    Args:
        noise: Noise model of the IMU.

    Attributes:
        orientation: (4,) wxyz, body to world.
        frame: (3, 3) the same as a matrix.
        velocity: (3,) velocity in the world, m/s; its vertical part is integrated, not corrected.
        bias: (3,) bias of the gyro in the body frame, rad/s.
    """

    def __init__(self, noise: ImuNoise | None = None) -> None:
        self.noise = noise or ImuNoise()
        self.bias = np.zeros(3)
        self._dt = 0.0
        self.start(np.array([0.0, 0.0, 1.0]))

    def start(self, up: Array) -> None:
        """Start at rest with heading 0 and the vertical `up` (3,) in the body frame.

        The estimate of the bias is kept.
        """
        self.orientation = np.empty(4)
        mujoco.mju_quatZ2Vec(self.orientation, up)
        self.orientation[1:] *= -1.0
        self.velocity = np.zeros(3)
        noise = self.noise
        start = [noise.start_tilt, noise.start_velocity, noise.start_bias]
        self._covariance = np.diag(np.square(start))
        self._yaw_variance = noise.start_bias**2
        self._look()

    @property
    def deviation(self) -> tuple[float, float]:
        """Standard deviations of the tilt, rad, and of the velocity, m/s."""
        return float(self._covariance[0, 0] ** 0.5), float(self._covariance[1, 1] ** 0.5)

    def predict(self, turn: Array, boost: Array, dt: float, doubt: float = 1.0) -> None:
        """Predict the state and its covariance over `dt` s.

        Args:
            turn: (3,) integral of the gyro, rad.
            boost: (3,) integral of the accelerometer, m/s.
            dt: Time since the last prediction, s.
            doubt: Factor on the standard deviations of the noise.
        """
        before = self.frame
        mujoco.mju_quatIntegrate(self.orientation, turn - self.bias * dt, 1.0)
        self._look()
        self.velocity = self.velocity + 0.5 * ((before + self.frame) @ boost)
        self.velocity[2] -= GRAVITY * dt
        if dt != self._dt:
            self._prepare(dt)
        p = self._step @ self._covariance @ self._step.T
        p += self._spread * doubt * doubt
        self._yaw_variance += self.noise.drift**2 * dt
        self._covariance = p

    def measure_velocity(self, velocity: Array, deviation: float) -> None:
        """Correct by a velocity (3,) m/s in the world, of which only x and y are used."""
        x, y, _ = (velocity - self.velocity).tolist()
        # The rotation by which gravity explains this velocity error: pitch for x, -roll for y.
        self._correct(1, deviation, self.frame.T @ (-y, x, 0.0), np.array([x, y, 0.0]))

    def measure_up(self, up: Array) -> None:
        """Correct by the vertical (3,) in the body frame, from the IMU's own orientation."""
        a, b = up.tolist(), self.frame[2].tolist()
        axis = np.array(
            [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ]
        )
        x, y, _ = (self.frame @ axis).tolist()
        self._correct(0, self.noise.fused, axis, np.array([y, -x, 0.0]))

    def measure_yaw_bias(self, bias: Array, deviation: float) -> None:
        """Correct by a gyro bias (3,) rad/s, of which only the vertical component is used."""
        gain = self._yaw_variance / (self._yaw_variance + deviation**2)
        up = self.frame[2]
        self.bias = self.bias + gain * float((bias - self.bias) @ up) * up
        self._yaw_variance *= 1.0 - gain

    def _prepare(self, dt: float) -> None:
        """Compute transition matrix and process noise for `dt` s."""
        noise, fall = self.noise, GRAVITY * dt
        self._dt = dt
        self._step = np.array([[1.0, 0.0, -dt], [fall, 1.0, -0.5 * fall * dt], [0.0, 0.0, 1.0]])
        self._spread = np.diag(np.square([noise.gyro, noise.acceleration, noise.drift])) * dt

    def _correct(self, row: int, deviation: float, axis: Array, along: Array) -> None:
        """Correct all states by a measurement of state `row` (0 tilt, 1 velocity).

        Args:
            row: Index of the measured state.
            deviation: Standard deviation of the measurement.
            axis: (3,) measured error as a rotation in the body frame.
            along: (3,) measured error as a velocity in the world.
        """
        p = self._covariance
        gain = p[row] / (p[row, row] + deviation**2)
        tilt, velocity, bias = gain.tolist()
        mujoco.mju_quatIntegrate(self.orientation, axis, tilt)
        self.velocity = self.velocity + velocity * along
        self.bias = self.bias + bias * axis
        self._covariance = p - gain[:, None] * p[row]
        self._look()

    def _look(self) -> None:
        flat = np.empty(9)
        mujoco.mju_quat2Mat(flat, self.orientation)
        self.frame = flat.reshape(3, 3)
