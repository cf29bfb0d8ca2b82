"""Emulated servos on a bus; importing this lets pyserial open ports named ``twin://...``.

An IMU on I2C is opened by the same URL, see `windup.hal.imu.i2c`.
"""

import serial

from windup.hal.imu.i2c import HANDLERS as I2C_HANDLERS
from windup.sim_twin.wire.serve.i2c import open_twin_i2c
from windup.sim_twin.wire.world.address import Address, parse_address
from windup.sim_twin.wire.world.build import build_world
from windup.sim_twin.wire.world.bus_world import BusWorld
from windup.sim_twin.wire.world.worlds import drop_world, find_world, put_world

HANDLERS = f"{__name__}.serve"
if HANDLERS not in serial.protocol_handler_packages:
    serial.protocol_handler_packages.append(HANDLERS)
I2C_HANDLERS["twin"] = open_twin_i2c

__all__ = [
    "Address",
    "BusWorld",
    "build_world",
    "drop_world",
    "find_world",
    "parse_address",
    "put_world",
]
