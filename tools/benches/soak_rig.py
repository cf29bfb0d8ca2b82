"""A bench of emulated servos with known positions, read through the real driver."""

from itertools import count
from types import TracebackType
from typing import Final, Self

import numpy as np

import windup.sim_twin.wire as wire
from windup.hal.families import servo_model
from windup.hal.joints import Array, Joint, Joints, Mask
from windup.hal.observation import Observation
from windup.hal.port.open_port import open_port
from windup.hal.port.port import LATENCY, Port
from windup.hal.servo_bus.servo_backend import BusPort, ServoBackend
from windup.hal.servos.servo_model import ServoMount
from windup.sim_twin.wire.faults.faults import Faults
from windup.sim_twin.wire.shafts.shaft import InertiaShaft
from windup.sim_twin.wire.world.bus_world import BenchPhysics

# Names of the families, with the servo that represents each.
FAMILIES: Final = {
    "dynamixel2": "XM430-W350",
    "dynamixel2_plain": "2XL430-W250",  # without fast sync read
    "dynamixel1": "MX-28",
    "ax": "AX-12A",
    "sts": "STS3215-7.4V",
    "scs": "SCS0009",
}
BAUD = 1_000_000
FASTEST = 9  # counts per cycle of the fastest servo; the slowest turns 1
SWING = 0.3  # amplitude around the middle, as a share of the encoder's range
_worlds = count()


def open_without_latency(url: str, baud: int) -> Port:
    """Open a port whose driver does not report the adapter's latency."""
    port = open_port(url, baud)
    port.latency = LATENCY
    return port


class PositionedShafts:
    """Physics in which the shafts move only when their positions are set."""

    def __init__(self, shafts: tuple[InertiaShaft, ...], timestep: float) -> None:
        self.shafts, self.timestep = shafts, timestep

    def step(self) -> None:
        """Do nothing for one time step."""


class SoakRig:
    """Servos of one family on a bench, their driver, and their true positions.

    Args:
        family: A key of `FAMILIES`.
        servos: Number of servos.
        seed: Seed of the faults and of the motion of the shafts.
        latency: Latency of the adapter, which the driver does not know, s.

    Attributes:
        backend: The driver, configured and with torque on.
        faults: The faults of the bus; none at first.
        truth: (servos,) true encoder positions, counts.
        url: URL of the port.
    """

    def __init__(self, family: str, servos: int = 20, seed: int = 0, latency: float = 0.0) -> None:
        model, rng = servo_model(FAMILIES[family]), np.random.default_rng(seed)
        self.name, self.servos = f"soak-{family}-{next(_worlds)}", servos
        self.url = (
            f"twin://bench?servos={FAMILIES[family]}:1-{servos}&baud={BAUD}&return_delay=0"
            f"&world={self.name}&seed={seed}&latency={1e3 * latency}"
        )
        self._model, ids = model, range(1, servos + 1)
        self._supply = min(12.0, model.rows[-1].voltage)
        stiffness = model.stiffness(model.p_default, self._supply)
        joints = Joints(tuple(Joint(f"servo {id}", -2.0, 2.0, stiffness, 0.1) for id in ids))
        mounts = [ServoMount(model, "body", id, 1, model.middle, 1.0) for id in ids]
        ports = {"body": BusPort(self.url, BAUD)}
        opener = open_without_latency if latency else open_port
        self.backend = ServoBackend(joints, mounts, ports, supply=self._supply, opener=opener)
        self.backend.connect()
        self.world = wire.find_world(self.name)
        bench = self.world.physics
        assert isinstance(bench, BenchPhysics)
        self._shafts = bench.shafts
        self.world.physics = PositionedShafts(self._shafts, bench.timestep)
        self._pace = 1 + rng.integers(0, FASTEST, servos)
        self._phase = rng.integers(0, model.encoder_counts, servos)
        self._reach = int(SWING * model.encoder_counts)
        self._cycle = 0
        self.truth: Array = np.zeros(servos)
        self.turn()
        self.backend.configure()
        self.backend.set_torque(True)

    @property
    def position_share(self) -> float:
        """Share of the position in the data bytes of a servo's answer."""
        family = self.backend.readouts[0].bus.family
        state = family.cycle([self._model]).state
        return family.registers["present_position"].size / state.size

    @property
    def faults(self) -> Faults:
        """The faults of the bus."""
        return self.world.faults

    def turn(self) -> None:
        """Turn every shaft at its own speed, to and fro within the encoder's range."""
        self._cycle += 1
        way = (self._phase + self._cycle * self._pace) % (4 * self._reach)
        zigzag = np.abs(way - 2 * self._reach) - self._reach
        self.truth = self._model.middle + zigzag.astype(np.float64)
        angles = zigzag * 2.0 * np.pi / self._model.counts_per_rev
        for shaft, angle in zip(self._shafts, angles.tolist(), strict=True):
            shaft.position = angle

    def read(self) -> tuple[Observation, Mask, Mask]:
        """Read once; return the observation, and (servos,) which readings are fresh and correct."""
        began = self.backend.clock.now()
        seen = self.backend.read()
        fresh: Mask = seen.joints.age <= seen.time - began
        return seen, fresh, np.rint(self.counts(seen)) == self.truth

    def counts(self, seen: Observation) -> Array:
        """Return the counts (servos,) behind an observation."""
        return self.backend.units.counts(seen.joints.position)

    def listening(self) -> Mask:
        """Return (servos,) bool: which servos are powered and have booted."""
        now = self.world.now
        return np.array([device.listens(now) for device in self.world.devices[: self.servos]])

    def repair(self, servo: int) -> None:
        """Repair the servo of this id."""
        self.world.repair(self.world.devices[servo - 1])

    def close(self) -> None:
        """Close the port and remove the world."""
        self.backend.disconnect()
        wire.unregister_world(self.name)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
