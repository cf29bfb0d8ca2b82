"""A BNO08x IMU in UART-RVC mode: it sends a frame a hundred times a second, and hears nothing.

Frame: ``AA AA, index, yaw, pitch, roll, acceleration x y z, three reserved bytes, checksum``. Words
are signed, low byte first; angles in 0.01 degrees; accelerations in 0.001 g. The checksum is the
sum of what lies between it and the header. The chip turns yaw about z, then pitch about x, then
roll about y: the data sheet's example, pitch -1.10 and roll 20.85 degrees, feels -0.371 g along x.
"""

import math
import struct
from collections.abc import Sequence
from functools import partial
from typing import Final

from windup.hal.geometry.gravity import STANDARD_GRAVITY
from windup.hal.joints import Array
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.bus.heard import Heard
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.imu.imu import ImuSource

HEADER: Final = b"\xaa\xaa"
BAUD: Final = 115_200
PERIOD: Final = 0.01  # s
ANGLE_UNIT = math.radians(0.01)  # rad
ACCELERATION_UNIT = 1e-3 * STANDARD_GRAVITY  # m/s2
BUFFER = 4096  # bytes that a host's driver keeps
_BODY = struct.Struct("<B6h3x")


def encode_rvc(index: int, imu: ImuSource) -> bytes:
    """Return the frame of what `imu` feels now."""
    angles = [angle / ANGLE_UNIT for angle in yaw_pitch_roll(imu.orientation)]
    words = [*angles, *(imu.acceleration / ACCELERATION_UNIT)]
    body = _BODY.pack(index & 0xFF, *(max(-32768, min(32767, round(word))) for word in words))
    return HEADER + body + bytes((sum(body) & 0xFF,))


def yaw_pitch_roll(quaternion: Array) -> tuple[float, float, float]:
    """Return the turns about z, then x, then y of a wxyz quaternion, rad."""
    w, x, y, z = quaternion
    return (
        math.atan2(2.0 * (w * z - x * y), 1.0 - 2.0 * (x * x + z * z)),
        math.asin(max(-1.0, min(1.0, 2.0 * (w * x + y * z)))),
        math.atan2(2.0 * (w * y - x * z), 1.0 - 2.0 * (x * x + y * y)),
    )


class Mute:
    """The language of who does not listen."""

    id_at, length_at, data_at, tail = 2, 2, 3, 1

    def seal(self, frame: bytes) -> bytes:
        """Return `frame` with its checksum."""
        return frame[:-1] + bytes((sum(frame[2:-1]) & 0xFF,))

    def meet(self, devices: Sequence[Device]) -> None:
        """There are none."""

    def feed(self, chunk: bytes) -> list[Heard]:
        """Hear nothing."""
        return []

    def reset(self) -> None:
        """Nothing has begun."""

    def execute(self, frame: Heard, bus: Bus) -> bool:
        """Do nothing."""
        return False


def start_rvc(bus: Bus, imu: ImuSource, start: float = PERIOD) -> None:
    """Let an IMU send on `bus` from `start` s on, for ever."""
    bus.schedule.at(start, partial(_send, bus, imu, 0, start))


def _send(bus: Bus, imu: ImuSource, count: int, start: float) -> None:
    if bus.queued > BUFFER:
        bus.discard()
    if not imu.silent:
        bus.answer(encode_rvc(count, imu), BAUD, count & 0xFF)
    count += 1
    bus.schedule.at(start + count * PERIOD, partial(_send, bus, imu, count, start))
