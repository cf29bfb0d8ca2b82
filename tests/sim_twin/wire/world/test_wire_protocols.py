"""Several protocols in one world, and what may hang where."""

import pytest
import serial
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.sim_twin.wire.wire_host1 import PING, open_host1, statuses
from windup.hal.families import servo_model
from windup.sim_twin.wire import register_world, unregister_world
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.protocols.frames import encode as encode2
from windup.sim_twin.wire.protocols.frames1 import encode
from windup.sim_twin.wire.schedule import Schedule
from windup.sim_twin.wire.shafts.shaft import InertiaShaft
from windup.sim_twin.wire.world.address import parse_address
from windup.sim_twin.wire.world.build import build_world
from windup.sim_twin.wire.world.bus_world import BenchPhysics, BusWorld
from windup.sim_twin.wire.world.families import make_protocol, make_servo
from windup.sim_twin.wire.world.own_emulations import PROTOCOLS

MIX = {"legs": "STS3215-12V", "arms": "AX-12A", "head": "XL430-W250", "face": "SCS0009"}


def mixed() -> BusWorld:
    schedule, shafts, buses = Schedule(), [], {}
    for bus, name in MIX.items():
        sheet = servo_model(name)
        supply = sheet.rows[-1].voltage
        shafts.append(InertiaShaft(sheet.motor(supply), sheet.armature))
        servo = make_servo(name, shafts[-1], 1, 1_000_000, supply, 0)
        devices: list[Device] = [servo]
        buses[bus] = Bus(bus, devices, make_protocol(PROTOCOLS[name]), schedule)
    return BusWorld(BenchPhysics(shafts), schedule, buses)


def test_four_families_on_four_buses_of_one_world() -> None:
    register_world("mix", mixed())
    try:
        for bus in ("legs", "arms", "face"):
            with open_host1(f"twin://any?world=mix&bus={bus}") as host:
                assert len(host.ask(1, PING)) == 1
                assert host.raw(encode2(1, 1)) == b""
        with open_host1("twin://any?world=mix&bus=head") as host:
            assert len(host.raw(encode2(1, 1))) == 14
            assert host.raw(encode(1, 1)) == b""
    finally:
        unregister_world("mix")


def test_buses_of_different_protocols_do_not_wait_for_each_other() -> None:
    register_world("mix", mixed())
    try:
        with (
            open_host1("twin://any?world=mix&bus=legs") as legs,
            open_host1("twin://any?world=mix&bus=arms") as arms,
        ):
            began = legs.now
            legs.port.write(encode(1, 2, b"\x38\x06"))
            arms.port.write(encode(1, 2, b"\x24\x06"))
            assert len(legs.port.read(12)) == len(arms.port.read(12)) == 12
            assert legs.now - began == pytest.approx(20e-5)
    finally:
        unregister_world("mix")


@pytest.mark.parametrize(
    ("url", "message"),
    [
        (
            "twin://bench?servos=STS3215:1,AX-12A:2",
            "AX-12A 2 uses protocol dynamixel1, its bus feetech",
        ),
        ("twin://bench?servos=STS3215:1&baud=2000000", "does not support 2000000 baud"),
        ("twin://bench?servos=STS3216:1", "unknown servo model 'STS3216'; did you mean"),
    ],
)
def test_what_cannot_hang_on_a_bus_is_refused(url: str, message: str) -> None:
    with pytest.raises(serial.SerialException, match=message):
        serial.serial_for_url(url)


def test_a_robot_may_be_shafts_alone_in_its_stance() -> None:
    world = build_world(parse_address("twin://op3?physics=inertia"))
    assert isinstance(world.physics, BenchPhysics)
    assert len(world.physics.shafts) == 20
    assert any(shaft.position for shaft in world.physics.shafts)


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from(["STS3215:1-2", "SCS0009:1-2", "AX-12A:1,MX-106:2"]),
    st.sampled_from([1, 2, 3, 4, 5, 6, 8, 0x0B, 0x82, 0x83, 0x92]),
    st.sampled_from([1, 2, 254]),
    st.binary(max_size=30),
)
def test_no_parameters_break_an_instruction(
    servos: str, instruction: int, identifier: int, parameters: bytes
) -> None:
    with open_host1(f"twin://bench?servos={servos}") as host:
        host.ask(identifier, instruction, parameters)
        host.wait(1.0)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.binary(max_size=40), max_size=6))
def test_no_bytes_of_a_host_break_the_bus(chunks: list[bytes]) -> None:
    with open_host1("twin://bench?servos=STS3215:1-2") as host:
        for chunk in chunks:
            host.port.write(chunk)
            host.wait(0.001)
        host.wait(0.5)
        assert [f.identifier for f in statuses(host.raw(encode(1, 1)))] == [1]
