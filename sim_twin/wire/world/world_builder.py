"""Builds the buses of one world, with the objects that they share."""

from windup.hal.imu.bno08x_rvc import BNO08X_RVC
from windup.hal.imu.kind import ImuKind
from windup.hal.imu.mounting import STRAIGHT
from windup.sim_twin.wire.boards.rvc import BAUD as RVC_BAUD
from windup.sim_twin.wire.boards.rvc import SendOnlyProtocol, start_rvc
from windup.sim_twin.wire.bus.bus import Bus, WireProtocol
from windup.sim_twin.wire.bus.timing import Timing
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.faults.faults import Faults
from windup.sim_twin.wire.imu.bno055 import Bno055Registers
from windup.sim_twin.wire.imu.imu import ImuSource, MountedImu
from windup.sim_twin.wire.imu.imu_faults import FaultyImu
from windup.sim_twin.wire.schedule import Schedule
from windup.sim_twin.wire.world.address import Address
from windup.sim_twin.wire.world.bus_world import BusWorld, Physics

NOMINAL = 12.0  # default supply on a bench, V, where the servos tolerate it
IMU = "imu"  # name of the port of a separate IMU


class WorldBuilder:
    """Builds the buses of one world, with the objects that they share.

    Args:
        address: Address of the world.
    """

    def __init__(self, address: Address) -> None:
        self.address = address
        self.schedule = Schedule()
        self.faults = Faults.parse(address.faults, address.seed)
        self.buses: dict[str, Bus] = {}

    def bus(self, name: str, devices: list[Device], protocol: WireProtocol, baud: int) -> Bus:
        """Add a bus."""
        address = self.address
        timing = Timing(
            address.latency * 1e-3, address.turnaround * 1e-6, address.missing == "wait"
        )
        bus = Bus(name, devices, protocol, self.schedule, baud, timing)
        self.buses[name] = bus
        return bus

    def imu(self, source: ImuSource, kind: ImuKind = BNO08X_RVC) -> None:
        """Add the port of an IMU that streams by itself, or the I2C bus of one that is polled."""
        bus = self.bus(IMU, [], SendOnlyProtocol(), RVC_BAUD)
        bus.imu = FaultyImu(source, self.schedule)
        felt: ImuSource = bus.imu
        if kind.mounting.axes != STRAIGHT:
            felt = MountedImu(felt, kind.mounting)
        if kind.wiring == "i2c":
            bus.chip = Bno055Registers(felt, self.schedule)
        else:
            start_rvc(bus, felt)

    def world(self, physics: Physics, supply: float, owned: tuple[object, ...] = ()) -> BusWorld:
        """Return the world with the buses added so far."""
        return BusWorld(physics, self.schedule, self.buses, supply, owned, self.faults)
