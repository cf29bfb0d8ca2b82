"""A BNO08x IMU in UART-RVC mode: it sends 100 frames a second and receives nothing.

Frame: ``AA AA, index, yaw, pitch, roll, acceleration x y z, three reserved bytes, checksum``. Words
are signed, low byte first; angles in 0.01 degrees; accelerations in 0.001 g. The checksum is the
sum of the bytes between the header and itself. The chip rotates yaw about z, then pitch about x,
then roll about y: the data sheet's example, pitch -1.10 and roll 20.85 degrees, measures -0.371 g
along x.
"""

import math
import struct
from collections.abc import Sequence
from functools import partial
from typing import Final

from windup.hal.geometry.gravity import STANDARD_GRAVITY
from windup.hal.geometry.quaternion import zxy_angles
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.bus.parsed_item import ParsedItem
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.imu.imu import ImuSource

HEADER: Final = b"\xaa\xaa"
BAUD: Final = 115_200
PERIOD: Final = 0.01  # s
ANGLE_UNIT = math.radians(0.01)  # rad
ACCELERATION_UNIT = 1e-3 * STANDARD_GRAVITY  # m/s2
BUFFER = 4096  # capacity of the host driver's receive buffer, bytes
_BODY = struct.Struct("<B6h3x")


def encode_rvc(index: int, imu: ImuSource) -> bytes:
    """Return the frame with the present readings of `imu`."""
    angles = [angle / ANGLE_UNIT for angle in zxy_angles(imu.orientation)]
    words = [*angles, *(imu.acceleration / ACCELERATION_UNIT)]
    body = _BODY.pack(index & 0xFF, *(max(-32768, min(32767, round(word))) for word in words))
    return HEADER + body + bytes((sum(body) & 0xFF,))


class SendOnlyProtocol:
    """The protocol of a bus whose only device ignores all bytes from the host."""

    id_at, length_at, data_at, tail = 2, 2, 3, 1

    def with_checksum(self, frame: bytes) -> bytes:
        """Return `frame` with its checksum."""
        return frame[:-1] + bytes((sum(frame[2:-1]) & 0xFF,))

    def set_devices(self, devices: Sequence[Device]) -> None:
        """Do nothing: there are no addressable devices."""

    def feed(self, chunk: bytes) -> list[ParsedItem]:
        """Ignore the bytes and return no frames."""
        return []

    def reset(self) -> None:
        """Do nothing: there is no partial frame."""

    def execute(self, frame: ParsedItem, bus: Bus) -> bool:
        """Do nothing; return False."""
        return False


def start_rvc(bus: Bus, imu: ImuSource, start: float = PERIOD) -> None:
    """Make an IMU send on `bus` periodically from `start`, s, without end."""
    bus.schedule.add(start, partial(_send, bus, imu, 0, start))


def _send(bus: Bus, imu: ImuSource, count: int, start: float) -> None:
    if bus.queued > BUFFER:
        bus.discard()
    if not imu.silent:
        bus.answer(encode_rvc(count, imu), BAUD, count & 0xFF)
    count += 1
    bus.schedule.add(start + count * PERIOD, partial(_send, bus, imu, count, start))
