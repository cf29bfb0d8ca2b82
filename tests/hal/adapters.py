"""The fake wires behind an adapter that holds answers back, or gives back what it is sent."""

from tests.hal.fake_bus import FakeSerial
from tests.hal.fake_bus1 import MX, SCS, STS, FakeSerial1
from windup.hal.families import DYNAMIXEL_1, DYNAMIXEL_X, FEETECH_SCS, FEETECH_STS, Family
from windup.hal.port.port import Port
from windup.hal.servos.servo_model import ServoModel


class Adapter(FakeSerial):
    """Attributes: `held` s by which all is late, `echoes` whether it gives back what it is sent."""

    held = 0.0
    echoes = False

    def write(self, data: bytes) -> int:
        before, now = len(self.arrivals), max(self.clock.time, self.busy)
        super().write(data)
        came, self.arrivals[before:] = self.arrivals[before:], []
        byte = 10.0 / self.baudrate
        echo = [(now + (at + 1) * byte, value) for at, value in enumerate(data)]
        both = [*echo, *came] if self.echoes else came
        self.arrivals += [(time + self.held, value) for time, value in both]
        return len(data)


class Adapter1(Adapter, FakeSerial1):
    """The same before servos of protocol 1."""


ONE_OF_EACH: dict[str, tuple[Family, ServoModel | None]] = {
    "X": (DYNAMIXEL_X, None),
    "MX": (DYNAMIXEL_1, MX),
    "STS": (FEETECH_STS, STS),
    "SCS": (FEETECH_SCS, SCS),
}


def adapter_port(maker: str, *ids: int) -> tuple[Adapter, Port, Family]:
    """Return the adapter before some servos of a maker, its port, and their family."""
    family, model = ONE_OF_EACH[maker]
    serial = Adapter([*ids]) if model is None else Adapter1(dict.fromkeys(ids, model))
    port = Port(serial, "fake://bus")
    port.latency = 1e-3  # what is believed where a driver says nothing
    return serial, port, family
