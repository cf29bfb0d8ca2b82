"""A small robot on fake wires: any servos on any buses, one virtual clock."""

from collections.abc import Sequence
from typing import Any

from tests.hal.fake_bus import FakeSerial, VirtualClock
from tests.hal.fake_bus1 import FakeSerial1
from windup.hal.errors import PortError
from windup.hal.joints import Joint, Joints
from windup.hal.port.port import Port
from windup.hal.servo_bus.servo_backend import BusPort, ServoBackend
from windup.hal.servos.servo_model import ServoModel, ServoMount


class Wires:
    """The fake serial objects by URL, and whether each is plugged in."""

    def __init__(self) -> None:
        self.clock = VirtualClock()
        self.serials: dict[str, FakeSerial] = {}
        self.unplugged: set[str] = set()
        self.open = 0

    def add(self, name: str, models: dict[int, ServoModel], protocol: int = 1) -> None:
        serial: FakeSerial
        if protocol == 1:
            serial = FakeSerial1(models, self.clock)
        else:
            serial = FakeSerial(list(models), self.clock)
            for id, model in models.items():
                serial.put(id, 0, model.model_number, 2)
        self.serials[name] = serial

    def __getitem__(self, name: str) -> Any:
        return self.serials[name]

    def opener(self, url: str, baud: int) -> Port:
        if url in self.unplugged:
            raise PortError(f"no port {url}")
        self.open += 1
        return Port(_Socket(self, url), url)


class _Socket:
    """One opening of a wire, which fails for ever once the wire was unplugged."""

    def __init__(self, wires: Wires, url: str) -> None:
        self._wires, self._url, self._serial = wires, url, wires.serials[url]
        self.clock, self.latency = wires.clock, 0.0
        self._gone = self._closed = False

    @property
    def baudrate(self) -> int:
        return self._serial.baudrate

    @baudrate.setter
    def baudrate(self, rate: int) -> None:
        self._serial.baudrate = rate

    @property
    def timeout(self) -> float | None:
        return self._serial.timeout

    @timeout.setter
    def timeout(self, seconds: float | None) -> None:
        self._serial.timeout = seconds

    def read(self, size: int = 1, /) -> bytes:
        self._check()
        return self._serial.read(size)

    def write(self, data: bytes, /) -> int:
        self._check()
        return self._serial.write(data)

    def reset_input_buffer(self) -> None:
        self._check()
        self._serial.reset_input_buffer()

    def close(self) -> None:
        if not self._closed:
            self._closed = True
            self._wires.open -= 1

    def _check(self) -> None:
        self._gone |= self._url in self._wires.unplugged or self._closed
        if self._gone:
            raise OSError("device disconnected")


def robot(
    wires: Wires,
    mounts: Sequence[ServoMount],
    reach: float = 1.0,
    supply: float = 7.4,
    **options: Any,
) -> ServoBackend:
    joints = Joints(
        tuple(
            Joint(f"j{row}", -reach, reach, round(mount.model.stiffness(20, supply), 6), 0.1)
            for row, mount in enumerate(mounts)
        )
    )
    ports = {mount.bus: BusPort(mount.bus, 1_000_000) for mount in mounts}
    return ServoBackend(joints, mounts, ports, supply=supply, opener=wires.opener, **options)


def mount(model: ServoModel, bus: str, id: int, sign: int = 1, ratio: float = 1.0) -> ServoMount:
    return ServoMount(model, bus, id, sign, model.middle, ratio)


def ticks(backend: ServoBackend, count: int, period: float = 0.008) -> None:
    for _ in range(count):
        backend.clock.wait_until(backend.clock.now() + period)
        backend.read()
