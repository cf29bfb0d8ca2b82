"""A host for the tests of protocol 1 buses: asks, and takes the answers apart."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Literal

import serial

import windup.sim_twin.wire  # noqa: F401 - makes twin:// known to pyserial
from windup.sim_twin.wire.protocols.frames1 import BROADCAST, Frame1, Parser1, encode
from windup.sim_twin.wire.servos.byte_servo import ByteServo
from windup.sim_twin.wire.shafts.shaft import InertiaShaft
from windup.sim_twin.wire.world.bus_world import BusWorld

PING, READ, WRITE, REG_WRITE, ACTION, RESET, REBOOT = 1, 2, 3, 4, 5, 6, 8
SYNC_READ, SYNC_WRITE, BULK_READ = 0x82, 0x83, 0x92


def statuses(data: bytes) -> list[Frame1]:
    """Return the good answers; their instruction is the error byte."""
    return [item for item in Parser1().feed(data) if isinstance(item, Frame1)]


def order(servo: ByteServo) -> Literal["big", "little"]:
    return "big" if servo.model == "SCS0009" else "little"


class Host1:
    def __init__(self, port: Any) -> None:
        self.port = port

    @property
    def world(self) -> BusWorld:
        world: BusWorld = self.port.world
        return world

    @property
    def now(self) -> float:
        return float(self.port.clock.now())

    def servo(self, identifier: int) -> ByteServo:
        for device in self.world.devices:
            if isinstance(device, ByteServo) and device.identifier == identifier:
                return device
        raise LookupError(identifier)

    def shaft(self, identifier: int) -> InertiaShaft:
        shaft = self.servo(identifier).loop.shaft
        assert isinstance(shaft, InertiaShaft)
        return shaft

    def place(self, identifier: int, counts: float) -> None:
        loop = self.servo(identifier).loop
        self.shaft(identifier).position = (counts - loop.centre) / loop.per_rad

    def wait(self, seconds: float) -> None:
        self.port.clock.wait_until(self.now + seconds)

    def raw(self, data: bytes | str, size: int = 4096) -> bytes:
        self.port.reset_input_buffer()
        self.port.write(bytes.fromhex(data) if isinstance(data, str) else data)
        answer: bytes = self.port.read(size)
        return answer

    def ask(self, identifier: int, instruction: int, data: bytes = b"") -> list[Frame1]:
        return statuses(self.raw(encode(identifier, instruction, data)))

    def write(self, identifier: int, name: str, value: int) -> int:
        """Return the error byte."""
        servo = self.servo(identifier)
        field = servo.table.fields[name]
        raw = (field.pack(value) & (1 << 8 * field.size) - 1).to_bytes(field.size, order(servo))
        (answer,) = self.ask(identifier, WRITE, bytes((field.address,)) + raw)
        return answer.instruction

    def read(self, identifier: int, name: str) -> int:
        servo = self.servo(identifier)
        field = servo.table.fields[name]
        (answer,) = self.ask(identifier, READ, bytes((field.address, field.size)))
        return field.unpack(int.from_bytes(answer.parameters, order(servo)))

    def sync_read(self, address: int, size: int, *ids: int) -> bytes:
        return self.raw(encode(BROADCAST, SYNC_READ, bytes((address, size, *ids))))


@contextmanager
def open_host1(url: str, baud: int = 1_000_000, timeout: float = 0.02) -> Iterator[Host1]:
    with serial.serial_for_url(url, baudrate=baud, timeout=timeout) as port:
        yield Host1(port)
