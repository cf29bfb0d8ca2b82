"""What a program sends goes on the wire as fast as that is, whatever it sends."""

import math

import pytest

from windup.sim_twin.wire.protocols.frames import encode
from windup.sim_twin.wire.serve.outlet import ON_THE_WIRE, WAITING, BusOutlet
from windup.sim_twin.wire.world.address import parse_address
from windup.sim_twin.wire.world.build import build_world
from windup.sim_twin.wire.world.bus_world import BusWorld

HEADERS = b"\xff\xff\xfd\x00" * 300_000  # 1.2 MB
PING = encode(1, 1)
ANSWER = 14  # bytes


class Program:
    """A link to a program that has sent `left`."""

    name = "test"

    def __init__(self, left: bytes = b"") -> None:
        self.left, self.got = left, b""

    def descriptors(self) -> list[int]:
        return [-1]

    def receive(self, most: int) -> bytes:
        data, self.left = self.left[:most], self.left[most:]
        return data

    def send(self, data: bytes) -> None:
        self.got += data

    def baud(self) -> int | None:
        return None

    def close(self) -> None:
        pass


@pytest.fixture
def world() -> BusWorld:
    return build_world(parse_address("twin://bench?servos=XM430-W350:1&return_delay=0"))


def outlet_of(world: BusWorld, program: Program) -> BusOutlet:
    outlet = BusOutlet(world.bus(), lambda: program)
    outlet.update_link()
    return outlet


def serve(world: BusWorld, outlet: BusOutlet, seconds: float) -> None:
    """Let time pass as an emulator does."""
    end = world.now + seconds
    while world.now < end:
        outlet.receive()
        outlet.feed()
        world.advance(world.now + 0.002)
        outlet.send(world.now)


def test_a_frame_goes_on_the_wire_at_once(world: BusWorld) -> None:
    program = Program(PING)
    outlet = outlet_of(world, program)
    outlet.receive()
    assert outlet.bus.backlog == pytest.approx(len(PING) * 1e-5)
    serve(world, outlet, 0.01)
    assert len(program.got) == ANSWER


def test_of_megabytes_what_does_not_fit_into_the_buffer_is_lost(world: BusWorld) -> None:
    program = Program(HEADERS)
    outlet = outlet_of(world, program)
    for _ in range(len(HEADERS) // 100_000):
        outlet.receive()
        assert len(outlet.waiting) <= WAITING
        assert outlet.bus.backlog <= ON_THE_WIRE + 1e-3
    assert program.left == b""
    program.left = PING
    serve(world, outlet, 0.5)
    assert program.got == b""  # it came while the buffer was full
    serve(world, outlet, 0.5)
    program.left = PING
    serve(world, outlet, 0.1)
    assert len(program.got) == ANSWER


def test_what_waited_is_lost_with_the_adapter(world: BusWorld) -> None:
    program = Program(HEADERS)
    outlet = outlet_of(world, program)
    outlet.receive()
    outlet.bus.set_plugged(False)
    outlet.update_link()
    assert not outlet.waiting and outlet.descriptors() == []


def test_megabytes_of_headers_in_one_write_leave_nothing_behind(world: BusWorld) -> None:
    bus = world.bus()
    bus.write(HEADERS[:200_000])
    assert bus.counts["dropped"] > 40_000
    assert bus.schedule.next == math.inf
