"""Builds a world of servos on a bench, each with its own inertia; does not need MuJoCo."""

from windup.hal.families import family_of, servo_model
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.imu.imu import RestingImu
from windup.sim_twin.wire.shafts.shaft import InertiaShaft
from windup.sim_twin.wire.world.address import BENCH, Address, parse_servos
from windup.sim_twin.wire.world.bus_world import BenchPhysics, BusWorld
from windup.sim_twin.wire.world.families import full_name, make_protocol, make_servo
from windup.sim_twin.wire.world.grips import bench_grips
from windup.sim_twin.wire.world.world_builder import NOMINAL, WorldBuilder

BAUD = 1_000_000
"""Default baud rate of the servos, bits/s."""


def bench_world(address: Address) -> BusWorld:
    """Return a new world with the servos of an address on one bus.

    Raises:
        UnknownNameError: There is no such servo model.
        UsageError: The servos use different protocols, or one does not support the baud rate.
    """
    baud, builder = address.baud or BAUD, WorldBuilder(address)
    servos = [(full_name(name), identifier) for name, identifier in parse_servos(address.servos)]
    protocol = family_of(servos[0][0]).protocol_name
    shafts: list[InertiaShaft] = []
    devices: list[Device] = []
    for name, identifier in servos:
        sheet = servo_model(name)
        supply = address.supply or min(NOMINAL, sheet.rows[-1].voltage)
        shafts.append(free_shaft(name, supply))
        devices.append(
            make_servo(name, shafts[-1], identifier, baud, supply, address.return_delay, protocol)
        )
    builder.bus(BENCH, devices, make_protocol(protocol), baud)
    if address.imu == "rvc":
        builder.imu(RestingImu())
    world = builder.world(BenchPhysics(shafts), address.supply or NOMINAL)
    world.grips = bench_grips(devices, shafts)
    return world


def free_shaft(name: str, supply: float) -> InertiaShaft:
    """Return a free shaft with the inertia, friction and motor of a servo model at `supply` V."""
    sheet = servo_model(name)
    return InertiaShaft(sheet.motor(supply), sheet.armature, sheet.friction_loss)
