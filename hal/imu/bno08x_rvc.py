"""BNO080, BNO085 and BNO086 in UART-RVC mode: 100 frames a second at 115,200 baud, nothing to ask.

A frame of 19 bytes, all numbers little-endian::

    AA AA | index | yaw, pitch, roll (0.01 deg) | ax, ay, az (0.001 g) | 3 reserved | checksum

The checksum is the sum of the bytes from the index to the last reserved one. The angles are those
of the chip's maker, who turns pitch about x and roll about y: ``R = Rz(yaw) Rx(pitch) Ry(roll)``.
The data sheet's own example says so: pitch -1.10 and roll 20.85 degrees go with an acceleration of
(-0.371, -0.020, 0.977) g, where the common order, roll about x, would put the 0.371 on y.

There is no gyroscope in a frame. The body's rates are the rotation between two frames over the
time between them, which the index counts in steps of 10 ms: half a frame late, and 0.01 degree of
resolution makes 0.017 rad/s of noise. A sample is as old as its frame is long on the wire, and
older by what its host lets it lie; `FrameClock` finds out how long.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from windup.hal.geometry.gravity import STANDARD_GRAVITY
from windup.hal.geometry.quaternion import conjugate, euler_zxy, multiply, rotate, rotation_between
from windup.hal.imu.frame_clock import FrameClock
from windup.hal.imu.kind import ImuKind
from windup.hal.imu.mounting import Mounting
from windup.hal.imu.serial_link import SerialLink
from windup.hal.joints import Array
from windup.hal.observation import ImuState
from windup.hal.port.port import Port
from windup.hal.port.port_reopener import Opener

HEADER = b"\xaa\xaa"
LENGTH = 19
PERIOD = 0.01
"""Time from one frame to the next, s."""
BAUD = 115_200
WIRE_TIME = 10 * LENGTH / BAUD
"""From a sample to the end of its frame, s."""
DEGREE = 0.01 * np.pi / 180.0
"""rad of one count of an angle."""
ACCELERATION = 1e-3 * STANDARD_GRAVITY
"""m/s2 of one count."""
LARGEST: Array = np.radians([180.0, 90.0, 180.0]) + 1e-9
"""Largest yaw, pitch and roll, rad."""
FASTEST = 35.0
"""rad/s: no IMU of this kind follows a faster turn, but a broken frame may say one."""
LONGEST_GAP = 10
"""Frames; behind a longer gap the index says nothing, and rates start anew."""
CUTOFF = 41.0
"""Of the accelerometer's low-pass filter, Hz. Assumed, as an MPU9250's: the data sheet has none."""
IDENTITY: Array = np.array([1.0, 0.0, 0.0, 0.0])
IDENTITY.setflags(write=False)


class Frame(NamedTuple):
    """One sample as the chip sends it.

    Attributes:
        number: Counts frames, modulo 256.
        angles: (3,) yaw, pitch and roll, rad.
        acceleration: (3,) m/s2 in the chip's axes.
    """

    number: int
    angles: Array
    acceleration: Array


class FrameParser:
    """Frames out of a stream that may begin anywhere and lose bytes.

    Attributes:
        corrupt: Headers that no good frame followed.
    """

    def __init__(self) -> None:
        self._rest = b""
        self.corrupt = 0

    def feed(self, data: bytes) -> Iterator[Frame]:
        """Yield the frames that `data` completes. What is no frame costs one byte."""
        stream = self._rest + data
        at = 0
        while (at := stream.find(HEADER, at)) >= 0 and at + LENGTH <= len(stream):
            frame = stream[at : at + LENGTH]
            if sum(frame[2:18]) & 0xFF == frame[18]:
                yield decode(frame)
                at += LENGTH
            else:
                self.corrupt += 1
                at += 1
        self._rest = stream[at:] if at >= 0 else stream[-1:]


def decode(frame: bytes) -> Frame:
    """Return the sample in one whole frame.

    >>> decode(bytes.fromhex("AAAADE010092FF25088DFEECFFD103000000E7")).number
    222
    """
    counts = np.frombuffer(frame, "<i2", count=6, offset=3).astype(np.float64)
    return Frame(frame[2], counts[:3] * DEGREE, counts[3:] * ACCELERATION)


class Bno08xRvc:
    """The IMU in the body frame.

    Args:
        url: Its port.
        mounting: (4,) wxyz, chip to body; by default their axes are the same.

    Attributes:
        lag: Delay of the accelerometer's own filter, s.
        parser: Bytes to frames, and how many were corrupt.
        implausible: Frames that said what cannot be; an 8-bit checksum passes one in 256.
    """

    baud = BAUD
    lag = 1.0 / (2.0 * np.pi * CUTOFF)

    def __init__(self, url: str, mounting: Array = IDENTITY) -> None:
        self.url = url
        self.mounting = np.asarray(mounting, dtype=np.float64) / np.linalg.norm(mounting)
        self._back = conjugate(self.mounting)
        self.parser = FrameParser()
        self._port: Port | None = None
        self._state: ImuState | None = None
        self._before: Array | None = None
        self._clock = FrameClock(PERIOD)
        self._index, self._seen, self._at = 0, -np.inf, -np.inf
        self.implausible = 0

    def connect(self, opener: Opener) -> SerialLink:
        """Open its port; see `ImuSource`."""
        return SerialLink(self, opener)

    def attach(self, port: Port) -> None:
        """Listen on `port` from now on; a frame begun on another port is forgotten."""
        self._port = port
        self.parser = FrameParser()
        self._clock.reset()
        self._seen = self._at = -np.inf

    def poll(self) -> None:
        """Take in what has come; waits for nothing.

        Raises:
            PortError: The port was disconnected.
        """
        if self._port is None:
            return
        now = self._port.clock.now()
        for frame in self.parser.feed(self._port.read(64 * LENGTH, now)):
            self._take(frame, now)

    def state(self, now: float) -> ImuState | None:
        """Return the last sample, aged to `now` s, or None before the first."""
        last = self._state
        if last is None:
            return None
        return ImuState(last.orientation, last.angular_velocity, last.acceleration, now - self._at)

    def _take(self, frame: Frame, now: float) -> None:
        orientation = multiply(euler_zxy(*frame.angles), self._back)
        rates = self._rates(frame.number, orientation, now)
        if rates is None:
            # The rates of a hole are unknown, and as 0 they would look as if they jumped.
            self._before = orientation
            self._index, self._seen = frame.number, now
            return
        if (np.abs(frame.angles) > LARGEST).any() or np.linalg.norm(rates) > FASTEST:
            self.implausible += 1
            return
        acceleration = rotate(self.mounting, frame.acceleration)
        self._state = ImuState(orientation, rates, acceleration, 0.0)
        self._before = orientation
        self._index, self._seen = frame.number, now
        self._at = self._clock.timestamp(frame.number, now) - WIRE_TIME

    def _rates(self, index: int, orientation: Array, now: float) -> Array | None:
        """Return the body's rates (3,) rad/s since the last frame; None where that is too old."""
        frames = (index - self._index) % 256
        recent = now - self._seen < LONGEST_GAP * PERIOD and 0 < frames <= LONGEST_GAP
        if self._before is None:
            return np.zeros(3)
        return rotation_between(self._before, orientation) / (frames * PERIOD) if recent else None


def _mounted(url: str, mounting: Mounting) -> Bno08xRvc:
    return Bno08xRvc(url, mounting.quaternion)


BNO08X_RVC = ImuKind(
    name="bno08x_rvc",
    wiring="serial",
    rate=1.0 / PERIOD,
    cutoff=CUTOFF,
    noise=(0.0, 0.0),  # below the resolution of a frame
    bias=(0.0, 0.05),  # our guess of the residual after calibration at rest
    count_size=(DEGREE / PERIOD, ACCELERATION),
    gyroscope=False,
    driver=_mounted,
)
