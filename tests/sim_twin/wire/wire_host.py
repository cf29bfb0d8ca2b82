"""A host for the tests of the emulated bus: asks, and takes the answers apart."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import serial

import windup.sim_twin.wire  # noqa: F401 - makes twin:// known to pyserial
from windup.sim_twin.wire.protocols.frames import BROADCAST, Frame, Parser, encode
from windup.sim_twin.wire.servos.servo import Servo
from windup.sim_twin.wire.shafts.shaft import InertiaShaft
from windup.sim_twin.wire.world.bus_world import BenchPhysics, BusWorld


class Host:
    def __init__(self, port: Any) -> None:
        self.port = port

    @property
    def world(self) -> BusWorld:
        world: BusWorld = self.port.world
        return world

    @property
    def now(self) -> float:
        return float(self.port.clock.now())

    def servo(self, identifier: int) -> Servo:
        for device in self.world.devices:
            if isinstance(device, Servo) and device.identifier == identifier:
                return device
        raise LookupError(identifier)

    def shaft(self, identifier: int) -> InertiaShaft:
        shaft = self.servo(identifier).firmware.loop.shaft
        assert isinstance(shaft, InertiaShaft)
        return shaft

    def wait(self, seconds: float) -> None:
        self.port.clock.wait_until(self.now + seconds)

    def raw(self, data: bytes, size: int = 4096) -> bytes:
        self.port.reset_input_buffer()
        self.port.write(data)
        answer: bytes = self.port.read(size)
        return answer

    def ask(self, identifier: int, instruction: int, data: bytes = b"") -> list[Frame]:
        found = Parser().feed(self.raw(encode(identifier, instruction, data)))
        return [frame for frame in found if isinstance(frame, Frame)]

    def write(self, identifier: int, name: str, value: int) -> int:
        """Return the error byte."""
        item = self.servo(identifier).registers.items[name]
        raw = (value & (1 << 8 * item.size) - 1).to_bytes(item.size, "little")
        (answer,) = self.ask(identifier, 3, item.address.to_bytes(2, "little") + raw)
        return answer.parameters[0]

    def read(self, identifier: int, name: str) -> int:
        item = self.servo(identifier).registers.items[name]
        where = item.address.to_bytes(2, "little") + item.size.to_bytes(2, "little")
        (answer,) = self.ask(identifier, 2, where)
        return int.from_bytes(answer.parameters[1:], "little", signed=item.signed)

    def sync_read(self, address: int, size: int, *ids: int, fast: bool = False) -> bytes:
        where = address.to_bytes(2, "little") + size.to_bytes(2, "little") + bytes(ids)
        return self.raw(encode(BROADCAST, 0x8A if fast else 0x82, where))

    def bench(self) -> BenchPhysics:
        physics = self.world.physics
        assert isinstance(physics, BenchPhysics)
        return physics


@contextmanager
def open_host(
    url: str = "twin://bench", baud: int = 1_000_000, timeout: float = 0.02
) -> Iterator[Host]:
    with serial.serial_for_url(url, baudrate=baud, timeout=timeout) as port:
        yield Host(port)
