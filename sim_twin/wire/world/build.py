"""Builds the world that an address names; imports MuJoCo only for a robot."""

from typing import TYPE_CHECKING

from windup.hal.errors import UsageError
from windup.sim_twin.wire.world.address import BENCH, Address
from windup.sim_twin.wire.world.bench_world import bench_world
from windup.sim_twin.wire.world.bus_world import BusWorld
from windup.sim_twin.wire.world.hand import parse_hands

if TYPE_CHECKING:
    from windup.sim_twin.environment import Environment


def build_world(address: Address, environment: "Environment | None" = None) -> BusWorld:
    """Return a new world.

    Args:
        address: Address of the world.
        environment: Ground and plant of a robot's twin.

    Raises:
        UnknownNameError: There is no such robot or servo.
        UsageError: The robot has no servos on a bus, or `environment` is given without a twin.
    """
    if environment is not None and (address.robot == BENCH or address.physics != "mujoco"):
        raise UsageError("ground and plant options need a robot with physics=mujoco")
    world = bench_world(address) if address.robot == BENCH else _robot(address, environment)
    for swing in parse_hands(address.hand):
        world.hand(swing)
    return world


def _robot(address: Address, environment: "Environment | None") -> BusWorld:
    """Return the world of a robot; the import here loads MuJoCo, which a bench does not need."""
    from windup.sim_twin.wire.world.robot_world import robot_world

    return robot_world(address, environment)
