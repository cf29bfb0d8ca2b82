"""Builds the world that an address names."""

import math
from dataclasses import replace

from windup.hal.errors import UsageError
from windup.hal.imu.bno08x_rvc import BNO08X_RVC
from windup.hal.imu.kind import ImuKind
from windup.hal.imu.mounting import STRAIGHT
from windup.hal.servos import servo_model
from windup.hal.servos.servo_model import ServoMount
from windup.robots import RobotDescription, load_robot
from windup.sim_twin.environment import Environment
from windup.sim_twin.twin import Twin
from windup.sim_twin.wire.boards.opencr import OpenCr
from windup.sim_twin.wire.boards.rvc import BAUD as RVC_BAUD
from windup.sim_twin.wire.boards.rvc import Mute, start_rvc
from windup.sim_twin.wire.bus.bus import Bus, Language
from windup.sim_twin.wire.bus.timing import Timing
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.faults.faults import Faults
from windup.sim_twin.wire.imu.bno055 import Bno055Registers
from windup.sim_twin.wire.imu.imu import ImuSource, MountedImu, RestingImu
from windup.sim_twin.wire.imu.imu_faults import FaultyImu
from windup.sim_twin.wire.schedule import Schedule
from windup.sim_twin.wire.shafts.shaft import InertiaShaft, Shaft
from windup.sim_twin.wire.shafts.twin_shaft import TwinImu, TwinPhysics, TwinShaft
from windup.sim_twin.wire.world.address import BENCH, Address, parse_servos
from windup.sim_twin.wire.world.bus_world import Bench, BusWorld, Physics
from windup.sim_twin.wire.world.families import PROTOCOLS, full_name, make_language, make_servo
from windup.sim_twin.wire.world.grips import bench_grips, robot_grips
from windup.sim_twin.wire.world.hand import parse_hands

NOMINAL = 12.0  # default supply on a bench, V, where the servos tolerate it
IMU = "imu"  # name of the port of a separate IMU


class Workshop:
    """Builds the buses of one world, with the objects that they share.

    Args:
        address: Address of the world.
    """

    def __init__(self, address: Address) -> None:
        self.address = address
        self.schedule = Schedule()
        self.faults = Faults.parse(address.faults, address.seed)
        self.buses: dict[str, Bus] = {}

    def bus(self, name: str, devices: list[Device], language: Language, baud: int) -> Bus:
        """Add a bus."""
        address = self.address
        timing = Timing(
            address.latency * 1e-3, address.turnaround * 1e-6, address.missing == "wait"
        )
        bus = Bus(name, devices, language, self.schedule, baud, timing)
        self.buses[name] = bus
        return bus

    def imu(self, source: ImuSource, kind: ImuKind = BNO08X_RVC) -> None:
        """Add the port of an IMU that streams by itself, or the I2C bus of one that is polled."""
        bus = self.bus(IMU, [], Mute(), RVC_BAUD)
        if kind.mounting.axes != STRAIGHT:
            source = MountedImu(source, kind.mounting)
        bus.imu = FaultyImu(source, self.schedule)
        if kind.wiring == "i2c":
            bus.chip = Bno055Registers(bus.imu, self.schedule)
        else:
            start_rvc(bus, bus.imu)

    def world(self, physics: Physics, supply: float, owned: tuple[object, ...] = ()) -> BusWorld:
        """Return the world with the buses added so far."""
        return BusWorld(physics, self.schedule, self.buses, supply, owned, self.faults)


def build_world(address: Address, around: Environment | None = None) -> BusWorld:
    """Return a new world.

    Args:
        address: Address of the world.
        around: Ground and plant of a robot's twin.

    Raises:
        UnknownNameError: There is no such robot or servo.
        UsageError: The robot has no servos on a bus, or `around` is given without a twin.
    """
    if around is not None and (address.robot == BENCH or address.physics != "mujoco"):
        raise UsageError("only a robot with physics=mujoco has another ground or plant")
    if address.robot == BENCH:
        world = _bench(address)
    else:
        world = _robot(address, load_robot(address.robot), around or Environment())
    for swing in parse_hands(address.hand):
        world.hand(swing)
    return world


def _bench(address: Address) -> BusWorld:
    baud, shop = address.baud or 1_000_000, Workshop(address)
    servos = [(full_name(name), identifier) for name, identifier in parse_servos(address.servos)]
    protocol = PROTOCOLS[servos[0][0]]
    shafts: list[InertiaShaft] = []
    devices: list[Device] = []
    for name, identifier in servos:
        sheet = servo_model(name)
        supply = address.supply or min(NOMINAL, sheet.rows[-1].voltage)
        shafts.append(_loose_shaft(name, supply))
        devices.append(
            make_servo(name, shafts[-1], identifier, baud, supply, address.return_delay, protocol)
        )
    shop.bus(BENCH, devices, make_language(protocol), baud)
    if address.imu == "rvc":
        shop.imu(RestingImu())
    world = shop.world(Bench(shafts), address.supply or NOMINAL)
    world.grips = bench_grips(devices, shafts)
    return world


def _robot(address: Address, robot: RobotDescription, around: Environment) -> BusWorld:
    if not any(robot.servos):
        raise UsageError(f"robot {robot.name!r} has no servos on a wire; 'windup walk' takes it")
    shop = Workshop(address)
    supply = address.supply or around.plant.supply or robot.drive.supply
    twin = None
    if address.physics == "mujoco":
        twin = Twin(robot, delay=0.0, supply=supply, world=_behind_a_wire(around, robot, supply))
    hung, shafts = _hang_servos(address, robot, twin, supply)
    source: ImuSource = RestingImu()
    if twin is not None and robot.imu_kind is not None:
        source = TwinImu(twin, robot.imu_kind.lag)
    _hang_buses(shop, robot, hung, source, supply)
    if twin is None:
        alone = [shaft for shaft in shafts if isinstance(shaft, InertiaShaft)]
        world = shop.world(Bench(alone, robot.timestep), supply)
        world.grips = robot_grips(robot, hung, shafts, None)
        return world
    horns = [shaft for shaft in shafts if isinstance(shaft, TwinShaft)]
    physics = TwinPhysics(
        twin, held=address.hold != "no", again=address.hold == "always", shafts=horns
    )
    if isinstance(source, TwinImu):
        source.held = lambda: physics.held
    world = shop.world(physics, supply, (twin,))
    world.grips = robot_grips(robot, hung, shafts, physics)
    return world


def _hang_buses(
    shop: Workshop,
    robot: RobotDescription,
    hung: dict[str, list[Device]],
    source: ImuSource,
    supply: float,
) -> None:
    """Add the buses of a robot with their servos, and its IMU: on the first of them, or apart."""
    address, first, kind = shop.address, robot.buses[0], robot.imu_kind
    felt = FaultyImu(source, shop.schedule)
    board = kind is not None and kind.wiring == "board"
    if kind is not None and board:
        servos, on, baud = hung[first.name], address.power == "on", address.baud or first.baud
        servos.append(OpenCr(felt, [*servos], baud, supply, powered=on, mounting=kind.mounting))
    for bus in robot.buses:
        shop.bus(bus.name, hung[bus.name], make_language(bus.protocol), address.baud or bus.baud)
    if board:
        shop.buses[first.name].imu = felt
    if address.imu == "rvc":
        shop.imu(source)
    elif address.imu == "auto" and kind is not None and not board:
        shop.imu(source, kind)


def _hang_servos(
    address: Address, robot: RobotDescription, twin: Twin | None, supply: float
) -> tuple[dict[str, list[Device]], list[Shaft]]:
    """Return the servos of each bus and all shafts: the twin's joints, or separate inertias."""
    buses = {bus.name: bus for bus in robot.buses}
    hung: dict[str, list[Device]] = {name: [] for name in buses}
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
        hung[mount.bus].append(
            make_servo(
                mount.model.name, shaft, mount.id, address.baud or bus.baud, supply,
                address.return_delay, bus.protocol,
            )
        )  # fmt: skip
    return hung, shafts


def _behind_a_wire(around: Environment, robot: RobotDescription, supply: float) -> Environment:
    """Return `around` with its plant's delay reduced by the delay that the bus adds itself."""
    plant = replace(around.plant, supply=supply)
    if plant.delay is not None:
        left = max(plant.delay - robot.drive.wire_delay, 0.0)
        plant = replace(plant, delay=round(left / robot.timestep) * robot.timestep)
    return replace(around, plant=plant)


def _loose_shaft(name: str, supply: float) -> InertiaShaft:
    sheet = servo_model(name)
    return InertiaShaft(sheet.motor(supply), sheet.armature, sheet.friction_loss)


def _posed_shaft(
    robot: RobotDescription, joint: int, mount: ServoMount, supply: float
) -> InertiaShaft:
    """Return a shaft at the angle of the joint in the robot's stance."""
    shaft = _loose_shaft(mount.model.name, supply)
    turn = mount.sign * mount.ratio * float(robot.stance[joint])
    per_rad = mount.model.counts_per_rev / (2.0 * math.pi)
    shaft.position = turn + (mount.zero - mount.model.middle) / per_rad
    return shaft
