"""Small robots of any servos on any buses, behind emulated wires: shafts with inertia alone."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Final

import numpy as np

from windup.hal.families import servo_model
from windup.hal.joints import Joint, Joints
from windup.hal.servo_bus.coupling import Coupling, Couplings
from windup.hal.servo_bus.servo_backend import BusPort, ServoBackend
from windup.hal.servos.servo_model import ServoMount
from windup.sim_twin.wire import register_world
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.schedule import Schedule
from windup.sim_twin.wire.shafts.shaft import InertiaShaft
from windup.sim_twin.wire.world.bus_world import BenchPhysics, BusWorld
from windup.sim_twin.wire.world.families import make_protocol, make_servo
from windup.sim_twin.wire.world.own_emulations import PROTOCOLS

BAUD = 1_000_000
REACH = 1.0  # rad, of every joint, both ways
_worlds = count()


@dataclass(frozen=True)
class Place:
    """One servo: of which joint, which model, on which bus, under which id, and how it sits."""

    joint: str
    model: str
    bus: str
    id: int
    sign: int = 1
    ratio: float = 1.0

    @property
    def mount(self) -> ServoMount:
        """The same for the driver."""
        model = servo_model(self.model)
        return ServoMount(model, self.bus, self.id, self.sign, model.middle, self.ratio)


PROTOCOL_1: Final = (
    Place("l_sho", "MX-28", "body", 1),
    Place("r_sho", "MX-64", "body", 2, sign=-1),
    Place("l_elbow", "AX-12A", "body", 3),
    Place("r_elbow", "AX-12A", "body", 4, sign=-1),
)
MX: Final = (
    Place("l_sho", "MX-28", "body", 1),
    Place("r_sho", "MX-28", "body", 2, sign=-1),
    Place("l_elbow", "MX-106", "body", 3),
)
SCS: Final = tuple(
    Place(name, "SCS0009", "body", 7 + row, sign=1 - 2 * (row % 2))
    for row, name in enumerate(("l_sho", "r_sho", "l_elbow", "r_elbow"))
)
# Two makers, three buses, STS and SCS in one process, a linkage, and an ankle of two rods.
MIXED: Final = (
    Place("l_sho", "XM430-W350", "arms", 1),
    Place("r_sho", "XM430-W350", "arms", 2, sign=-1, ratio=2.0),
    Place("ankle_pitch", "STS3215-12V", "legs", 1),
    Place("ankle_roll", "STS3215-12V", "legs", 2),
    Place("l_elbow", "STS3215-12V", "legs", 3, sign=-1),
    Place("r_elbow", "SCS0009", "head", 1),
)
ANKLE: Final = Coupling("ankle_pitch", "ankle_roll", ((1.0, 0.5), (1.0, -0.5)))


def bench_robot(places: Sequence[Place], couplings: Sequence[Coupling] = ()) -> ServoBackend:
    """Return the driver of a robot, not yet connected, and put its world where it finds it."""
    name, supply = f"bench-robot-{next(_worlds)}", _supply(places)
    register_world(name, _world(places, supply))
    joints = _joints(places, couplings, supply)
    mounts = [place.mount for place in places]
    ports = {
        bus: BusPort(f"twin://any?world={name}&bus={bus}", BAUD)
        for bus in dict.fromkeys(place.bus for place in places)
    }
    return ServoBackend(joints, mounts, ports, supply=supply, couplings=couplings)


def _supply(places: Sequence[Place]) -> float:
    """Return what all stand, at most 12 V."""
    return min(12.0, *(max(row.voltage for row in place.mount.model.rows) for place in places))


def _joints(places: Sequence[Place], couplings: Sequence[Coupling], supply: float) -> Joints:
    """Return joints as stiff as the servos leave the factory."""
    plain = Joints(tuple(Joint(place.joint, -REACH, REACH, 1.0, 0.0) for place in places))
    models = [place.mount.model for place in places]
    squares = np.array([place.ratio**2 for place in places])
    stiffness = squares * [model.stiffness(model.p_default, supply) for model in models]
    damping = squares * [model.damping(supply) for model in models]
    both = Couplings(plain, couplings)
    rows = zip(plain.names, both.joint_gains(stiffness), both.joint_gains(damping), strict=True)
    return Joints(tuple(Joint(name, -REACH, REACH, float(kp), float(kd)) for name, kp, kd in rows))


def _world(places: Sequence[Place], supply: float) -> BusWorld:
    schedule, shafts = Schedule(), []
    hung: dict[str, list[Device]] = {}
    for place in places:
        sheet = servo_model(place.model)
        shafts.append(InertiaShaft(sheet.motor(supply), sheet.armature, sheet.friction_loss))
        servo = make_servo(place.model, shafts[-1], place.id, BAUD, supply, 0)
        hung.setdefault(place.bus, []).append(servo)
    protocols = {place.bus: PROTOCOLS[place.model] for place in places}
    buses = {
        name: Bus(name, devices, make_protocol(protocols[name]), schedule, BAUD)
        for name, devices in hung.items()
    }
    return BusWorld(BenchPhysics(shafts), schedule, buses, supply)


Opener = Callable[[], ServoBackend]
ROBOTS: Final[dict[str, Opener]] = {
    "MX and AX under protocol 1": lambda: bench_robot(PROTOCOL_1),
    "MX under protocol 1": lambda: bench_robot(MX),
    "SCS": lambda: bench_robot(SCS),
    "a robot of two makers": lambda: bench_robot(MIXED, [ANKLE]),
}
