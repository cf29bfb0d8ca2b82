"""Emulated servos on a bus; importing this lets pyserial open ports named ``twin://...``.

The worlds are imported when one of the public names is first used. An IMU on I2C is opened by the
same URL, see `windup.hal.imu.i2c`.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

import serial

from windup.hal.imu.i2c import HANDLERS as I2C_HANDLERS
from windup.hal.imu.i2c import I2cChip

if TYPE_CHECKING:
    from windup.sim_twin.wire.world.address import Address, parse_address
    from windup.sim_twin.wire.world.build import build_world
    from windup.sim_twin.wire.world.bus_world import BusWorld
    from windup.sim_twin.wire.world.worlds import find_world, register_world, unregister_world

HANDLERS = f"{__name__}.serve"
if HANDLERS not in serial.protocol_handler_packages:
    serial.protocol_handler_packages.append(HANDLERS)


def _open_i2c(url: str, address: int) -> I2cChip:
    """Open an emulated chip; the import here loads the worlds."""
    from windup.sim_twin.wire.serve.i2c import open_twin_i2c

    return open_twin_i2c(url, address)


I2C_HANDLERS["twin"] = _open_i2c

PLACES: Final = {
    "Address": "address",
    "BusWorld": "bus_world",
    "build_world": "build",
    "unregister_world": "worlds",
    "find_world": "worlds",
    "parse_address": "address",
    "register_world": "worlds",
}
"""Public name to its module in `windup.sim_twin.wire.world`."""

__all__ = [
    "Address",
    "BusWorld",
    "build_world",
    "find_world",
    "parse_address",
    "register_world",
    "unregister_world",
]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for.

    Raises:
        AttributeError: There is no such name.
    """
    if name not in PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.world.{PLACES[name]}"), name)
