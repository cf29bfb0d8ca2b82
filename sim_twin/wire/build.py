"""Builds the world that an address names."""

from hal.errors import UsageError
from hal.servos import servo_model
from robots import RobotDescription, load_robot
from sim_twin.twin import Twin
from sim_twin.wire.address import BENCH, Address, parse_servos
from sim_twin.wire.bus import Bus, Timing
from sim_twin.wire.device import Device
from sim_twin.wire.dynamixel2 import Dynamixel2
from sim_twin.wire.faults import Faults
from sim_twin.wire.opencr import OpenCr
from sim_twin.wire.schedule import Schedule
from sim_twin.wire.servo import Servo
from sim_twin.wire.shaft import InertiaShaft
from sim_twin.wire.twin_shaft import TwinImu, TwinPhysics, TwinShaft
from sim_twin.wire.world import Bench, World
from sim_twin.wire.x_series import model

NOMINAL = 12.0  # V, for servos that stand so much


def build_world(address: Address) -> World:
    """Return a new world.

    Raises:
        UnknownNameError: There is no such robot or servo.
        UsageError: The robot has nothing on a wire.
    """
    if address.robot == BENCH:
        return _bench(address)
    return _robot(address, load_robot(address.robot))


def _bench(address: Address) -> World:
    baud = address.baud or 1_000_000
    shafts: list[InertiaShaft] = []
    devices: list[Device] = []
    for name, identifier in parse_servos(address.servos):
        table = model(name)
        sheet = servo_model(table.name)
        supply = address.supply or min(NOMINAL, sheet.rows[-1].voltage)
        shaft = InertiaShaft(sheet.motor(supply), sheet.armature, sheet.friction_loss)
        shafts.append(shaft)
        devices.append(
            Servo(
                table,
                sheet,
                shaft,
                identifier,
                baud,
                supply,
                return_delay_time=address.return_delay,
            )
        )
    schedule = Schedule()
    buses = {BENCH: _bus(address, BENCH, devices, schedule, baud)}
    return World(Bench(shafts), schedule, buses, address.supply or NOMINAL)


def _robot(address: Address, robot: RobotDescription) -> World:
    supply = address.supply or robot.drive.supply
    twin = Twin(robot, delay=0.0, supply=supply)
    hung: dict[str, list[Device]] = {bus.name: [] for bus in robot.buses}
    for joint, mount in enumerate(robot.servos):
        if mount is None:
            continue
        baud = address.baud or next(bus.baud for bus in robot.buses if bus.name == mount.bus)
        shaft = TwinShaft(twin, joint, mount)
        hung[mount.bus].append(
            Servo(
                model(mount.model.name), mount.model, shaft, mount.id, baud, supply,
                return_delay_time=address.return_delay,
            )
        )  # fmt: skip
    if not any(hung.values()):
        raise UsageError(f"robot {robot.name!r} has no servos on a wire; 'windup walk' takes it")
    if robot.imu is not None and robot.buses[0].protocol == "dynamixel2":
        first = robot.buses[0]
        board = OpenCr(
            TwinImu(twin), [*hung[first.name]], address.baud or first.baud, supply,
            powered=address.power == "on",
        )  # fmt: skip
        hung[first.name].append(board)
    schedule = Schedule()
    buses = {
        bus.name: _bus(address, bus.name, hung[bus.name], schedule, address.baud or bus.baud)
        for bus in robot.buses
    }
    physics = TwinPhysics(twin, held=address.hold == "yes")
    return World(physics, schedule, buses, supply, owned=(twin,))


def _bus(address: Address, name: str, devices: list[Device], schedule: Schedule, baud: int) -> Bus:
    timing = Timing(address.latency * 1e-3, address.turnaround * 1e-6, address.missing == "wait")
    faults = Faults.parse(address.faults, address.seed)
    return Bus(name, devices, Dynamixel2(), schedule, baud, timing, faults)
