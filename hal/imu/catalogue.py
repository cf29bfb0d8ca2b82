"""All kinds of IMU that Windup knows, by their names in robot.toml."""

from windup.hal.errors import UnknownNameError
from windup.hal.imu.bno055 import BNO055
from windup.hal.imu.bno08x_rvc import BNO08X_RVC
from windup.hal.imu.kind import ImuKind
from windup.hal.imu.open_duck import OPEN_DUCK
from windup.hal.imu.opencr import OPENCR

_KINDS = {kind.name: kind for kind in (OPENCR, BNO08X_RVC, BNO055, OPEN_DUCK)}


def imu_kind(name: str) -> ImuKind:
    """Return the kind of IMU called `name`.

    >>> imu_kind("bno055").wiring
    'i2c'

    Raises:
        UnknownNameError: There is no such kind; the message names the likely one.
    """
    try:
        return _KINDS[name]
    except KeyError:
        raise UnknownNameError("kind of IMU", name, _KINDS) from None


def usual_kind(protocol: str | None) -> ImuKind:
    """Return the default kind for a robot whose first servo bus has `protocol`; None: no bus.

    An OpenCR for "dynamixel2" and without a bus, a BNO08x with its own port otherwise.
    """
    return OPENCR if protocol in (None, "dynamixel2") else BNO08X_RVC
