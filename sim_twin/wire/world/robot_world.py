"""Builds the world of a robot: its servo buses with its twin, or with separate inertias."""

import math
from dataclasses import replace

from windup.hal.errors import UsageError
from windup.hal.servos.servo_model import ServoMount
from windup.robots import RobotDescription, load_robot
from windup.sim_twin.environment import Environment
from windup.sim_twin.twin import Twin
from windup.sim_twin.wire.boards.opencr import OpenCr
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.imu.imu import ImuSource, RestingImu
from windup.sim_twin.wire.imu.imu_faults import FaultyImu
from windup.sim_twin.wire.shafts.shaft import InertiaShaft, Shaft
from windup.sim_twin.wire.shafts.twin_shaft import TwinImu, TwinPhysics, TwinShaft
from windup.sim_twin.wire.world.address import Address
from windup.sim_twin.wire.world.bench_world import free_shaft
from windup.sim_twin.wire.world.bus_world import BenchPhysics, BusWorld
from windup.sim_twin.wire.world.families import make_protocol, make_servo
from windup.sim_twin.wire.world.robot_grips import robot_grips
from windup.sim_twin.wire.world.world_builder import WorldBuilder


def robot_world(address: Address, environment: Environment | None = None) -> BusWorld:
    """Return a new world with the buses of a robot.

    Args:
        address: Address of the world.
        environment: Ground and plant of its twin; by default flat, and as in the robot's files.

    Raises:
        UnknownNameError: There is no such robot.
        UsageError: The robot has no servos on a bus.
    """
    robot, environment = load_robot(address.robot), environment or Environment()
    if not any(robot.servos):
        raise UsageError(
            f"robot {robot.name!r} has no servos on a bus; omit the port to run its twin"
        )
    builder = WorldBuilder(address)
    supply = address.supply or environment.plant.supply or robot.drive.supply
    twin = None
    if address.physics == "mujoco":
        twin = Twin(
            robot, delay=0.0, supply=supply, world=_behind_a_wire(environment, robot, supply)
        )
    mounted, shafts = _hang_servos(address, robot, twin, supply)
    source = _motion(robot, twin)
    _add_buses(builder, robot, mounted, source, supply)
    if twin is None:
        alone = [shaft for shaft in shafts if isinstance(shaft, InertiaShaft)]
        world = builder.world(BenchPhysics(alone, robot.timestep), supply)
        world.grips = robot_grips(robot, mounted, shafts, None)
        return world
    physics = TwinPhysics(
        twin,
        held=address.hold != "no",
        hold_again=address.hold == "always",
        shafts=[shaft for shaft in shafts if isinstance(shaft, TwinShaft)],
    )
    if isinstance(source, TwinImu):
        source.held = lambda: physics.held
    world = builder.world(physics, supply, (twin,))
    world.grips = robot_grips(robot, mounted, shafts, physics)
    return world


def _motion(robot: RobotDescription, twin: Twin | None) -> ImuSource:
    """Return the motion that the robot's IMU measures: its twin's, or rest without a twin."""
    kind = robot.imu_kind
    return RestingImu() if twin is None or kind is None else TwinImu(twin, kind.lag)


def _add_buses(
    builder: WorldBuilder,
    robot: RobotDescription,
    mounted: dict[str, list[Device]],
    source: ImuSource,
    supply: float,
) -> None:
    """Add the robot's buses with their servos and board, and the port of a separate IMU."""
    address, first, kind = builder.address, robot.buses[0], robot.imu_kind
    felt = FaultyImu(source, builder.schedule)
    board = kind is not None and kind.wiring == "board"
    if kind is not None and board:
        servos, on, baud = mounted[first.name], address.power == "on", address.baud or first.baud
        servos.append(OpenCr(felt, [*servos], baud, supply, powered=on, mounting=kind.mounting))
    for bus in robot.buses:
        builder.bus(
            bus.name, mounted[bus.name], make_protocol(bus.protocol), address.baud or bus.baud
        )
    if board:
        builder.buses[first.name].imu = felt
    if address.imu == "rvc":
        builder.imu(source)
    elif address.imu == "auto" and kind is not None and not board:
        builder.imu(source, kind)


def _hang_servos(
    address: Address, robot: RobotDescription, twin: Twin | None, supply: float
) -> tuple[dict[str, list[Device]], list[Shaft]]:
    """Return the servos of each bus and all shafts: the twin's joints, or separate inertias."""
    buses = {bus.name: bus for bus in robot.buses}
    mounted: dict[str, list[Device]] = {name: [] for name in buses}
    shafts: list[Shaft] = []
    for joint, mount in enumerate(robot.servos):
        if mount is None:
            continue
        shaft: Shaft
        if twin is None:
            shaft = _posed_shaft(robot, joint, mount, supply)
        else:
            shaft = TwinShaft(twin, joint, mount)
        shafts.append(shaft)
        bus = buses[mount.bus]
        mounted[mount.bus].append(
            make_servo(
                mount.model.name, shaft, mount.id, address.baud or bus.baud, supply,
                address.return_delay, bus.protocol,
            )
        )  # fmt: skip
    return mounted, shafts


def _behind_a_wire(environment: Environment, robot: RobotDescription, supply: float) -> Environment:
    """Return `environment` with its plant's delay reduced by the delay that the bus adds itself."""
    plant = replace(environment.plant, supply=supply)
    if plant.delay is not None:
        left = max(plant.delay - robot.drive.wire_delay, 0.0)
        plant = replace(plant, delay=round(left / robot.timestep) * robot.timestep)
    return replace(environment, plant=plant)


def _posed_shaft(
    robot: RobotDescription, joint: int, mount: ServoMount, supply: float
) -> InertiaShaft:
    """Return a shaft at the angle of the joint in the robot's stance."""
    shaft = free_shaft(mount.model.name, supply)
    turn = mount.sign * mount.ratio * float(robot.stance[joint])
    per_rad = mount.model.counts_per_rev / (2.0 * math.pi)
    shaft.position = turn + (mount.zero - mount.model.middle) / per_rad
    return shaft
