"""What befalls servos, supply, adapter and board while a bus runs, on the virtual clock."""

import math
from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host import Host, open_host
from windup.sim_twin.wire import build_world, parse_address
from windup.sim_twin.wire.boards.opencr import USER_BUTTON, OpenCr
from windup.sim_twin.wire.faults.fault_text import parse_rules
from windup.sim_twin.wire.servos.health import OVERHEATING
from windup.sim_twin.wire.world.bus_world import BusWorld

XM, XL = 1, 2
BUTTON = bytes((30, 0, 1, 0))


@pytest.fixture
def host() -> Iterator[Host]:
    with open_host("twin://bench?servos=XM430-W350:1,XL330:2&return_delay=0") as host:
        yield host


@pytest.fixture
def op3() -> BusWorld:
    return build_world(parse_address("twin://op3?physics=inertia"))


def inject(host: Host, text: str) -> None:
    """Let faults begin now, as a running emulator does."""
    host.port.world.faults.inject(parse_rules(text, live=True), host.now)


def board_of(world: BusWorld) -> OpenCr:
    (board,) = (device for device in world.devices if isinstance(device, OpenCr))
    return board


def test_heat_comes_at_once_stays_for_its_time_and_goes(host: Host) -> None:
    inject(host, "heat:ids=1:seconds=1")
    host.wait(0.1)
    assert host.read(XM, "present_temperature") == 75
    assert host.read(XL, "present_temperature") == 25
    host.wait(0.8)
    assert host.read(XM, "present_temperature") == 75
    host.wait(20.0)
    assert host.read(XM, "present_temperature") < 75


def test_heat_without_an_end_makes_an_x_servo_shut_down(host: Host) -> None:
    host.write(XM, "torque_enable", 1)
    inject(host, "heat:degrees=81:ids=1")
    host.wait(0.1)
    assert host.read(XM, "hardware_error_status") == OVERHEATING
    assert host.read(XM, "torque_enable") == 0
    host.wait(100.0)
    assert host.read(XM, "present_temperature") == 81


def test_the_supply_sinks_for_good(host: Host) -> None:
    inject(host, "brown_out:volts=9:seconds=inf")
    host.wait(100.0)
    assert host.read(XM, "present_input_voltage") == 90
    assert host.world.volts == 9.0


def test_of_two_brown_outs_the_deeper_counts_and_each_ends_by_itself(host: Host) -> None:
    full = host.read(XL, "present_input_voltage")
    inject(host, "brown_out:volts=4:seconds=2,brown_out:volts=0:seconds=0.5:at=1")
    host.wait(0.5)
    assert (host.world.volts, host.read(XL, "present_input_voltage")) == (4.0, 40)
    host.wait(0.7)
    assert (host.world.volts, host.ask(XL, 1)) == (0.0, [])
    host.wait(0.7)
    assert (host.world.volts, host.read(XL, "present_input_voltage")) == (4.0, 40)
    host.wait(0.5)
    assert host.read(XL, "present_input_voltage") == full


def test_an_adapter_that_is_pulled_out_for_good_does_not_come_back(op3: BusWorld) -> None:
    op3.faults.unplug(at=0.1, seconds=0.5).unplug(at=0.2, seconds=math.inf)
    op3.advance(10.0)
    assert not op3.bus().plugged


def test_of_two_times_without_an_adapter_the_later_end_counts(op3: BusWorld) -> None:
    op3.faults.unplug(at=0.1, seconds=1.0).unplug(at=0.2, seconds=0.1)
    op3.advance(1.0)
    assert not op3.bus().plugged
    op3.advance(1.2)
    assert op3.bus().plugged


def test_events_that_are_over_are_forgotten(host: Host) -> None:
    inject(host, "reset:ids=1:at=0;0.5")
    faults = host.port.world.faults
    host.wait(0.1)
    assert faults.active
    host.wait(0.5)
    assert faults.counts["reset"] == 2 and not faults.active


def test_what_is_injected_with_a_rate_goes_on(host: Host) -> None:
    inject(host, "drop:1:ids=2")
    host.wait(1.0)
    assert host.ask(XL, 1) == [] and len(host.ask(XM, 1)) == 1


@pytest.mark.parametrize("again", ["reset", "brown_out"])
def test_a_servo_that_starts_again_counts_its_realtime_tick_from_0(host: Host, again: str) -> None:
    host.wait(20.0)
    assert host.read(XM, "realtime_tick") >= 20_000
    inject(host, again)
    host.wait(1.0)
    assert host.read(XM, "realtime_tick") <= 1000


def test_the_realtime_tick_wraps_behind_32767(host: Host) -> None:
    host.wait(33.0)
    assert host.read(XM, "realtime_tick") < 300


def test_the_user_button_is_pressed_for_its_time(op3: BusWorld) -> None:
    board = board_of(op3)
    op3.faults.button(at=0.1)
    for until, pressed in ((0.09, 0), (0.15, USER_BUTTON), (0.29, USER_BUTTON), (0.31, 0)):
        op3.advance(until)
        assert board.read(30, 1, op3.now) == (0, bytes((pressed,)))


def test_only_the_board_has_a_button(op3: BusWorld) -> None:
    faults = op3.faults.button(at=0.1)
    op3.advance(0.2)
    assert [(hit.kind, hit.identifier) for hit in faults.hits] == [("button", 200)]


def test_a_dead_servo_stays_dead_when_the_board_switches_the_power(op3: BusWorld) -> None:
    servo = next(device for device in op3.devices if device.identifier == 13)
    op3.faults.dead(ids=[13], at=0.1).brown_out(at=0.2)
    op3.advance(1.0)
    board_of(op3).write(24, b"\x01", op3.now)
    op3.advance(2.0)
    assert not servo.listens(op3.now) and servo.supply == 0.0
    assert sum(device.listens(op3.now) for device in op3.devices) == 20


def test_infinite_seconds_undo_nothing(op3: BusWorld) -> None:
    op3.faults.button(at=0.1, seconds=math.inf)
    op3.advance(50.0)
    assert board_of(op3).buttons == USER_BUTTON
