"""Turns, homing offset and reverse mode of an X servo, as the e-Manual has them."""

import math
from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host import Host, open_host
from windup.sim_twin.wire.servos.register_file import OK

XM = 1
VELOCITY, POSITION, EXTENDED, CURRENT_POSITION = 1, 3, 4, 5
TURN, MIDDLE = 4096, 2048


@pytest.fixture
def host() -> Iterator[Host]:
    with open_host("twin://bench?servos=XM430-W350:1&return_delay=0") as host:
        yield host


def place(host: Host, counts: float) -> None:
    """Turn the shaft by hand to where a servo without any settings would count `counts`."""
    host.shaft(XM).position = (counts - MIDDLE) * 2.0 * math.pi / TURN


def position(host: Host) -> int:
    return host.read(XM, "present_position")


def test_without_torque_the_position_runs_on_through_0_and_4096(host: Host) -> None:
    for counts in (-1, -5000, 4096, 9000):
        place(host, counts)
        assert position(host) == counts


def test_torque_on_in_position_mode_forgets_the_turns(host: Host) -> None:
    place(host, -100)
    assert position(host) == -100
    host.write(XM, "torque_enable", 1)
    assert position(host) == host.read(XM, "goal_position") == TURN - 100


def test_a_shaft_that_is_pushed_below_0_in_position_mode_counts_below_0(host: Host) -> None:
    place(host, 10)
    host.write(XM, "torque_enable", 1)
    host.write(XM, "goal_position", 0)
    host.shaft(XM).load = -1.0
    host.wait(1.0)
    assert -100 < position(host) < 0
    host.write(XM, "torque_enable", 0)
    assert -200 < position(host) < 0


@pytest.mark.parametrize("mode", [EXTENDED, CURRENT_POSITION])
def test_extended_modes_count_turns_also_below_0(host: Host, mode: int) -> None:
    assert host.write(XM, "operating_mode", mode) == OK
    assert host.write(XM, "torque_enable", 1) == OK
    for goal in (9000, -9000):
        assert host.write(XM, "goal_position", goal) == OK
        host.wait(6.0)
        assert position(host) == pytest.approx(goal, abs=3)
    host.write(XM, "torque_enable", 0)
    host.write(XM, "torque_enable", 1)
    assert position(host) == pytest.approx(-9000, abs=30)  # it coasts a little


@pytest.mark.parametrize("mode", [POSITION, VELOCITY])
def test_a_change_of_mode_forgets_the_turns(host: Host, mode: int) -> None:
    host.write(XM, "operating_mode", EXTENDED)
    place(host, 9000)
    assert position(host) == 9000
    host.write(XM, "operating_mode", mode)
    assert position(host) == 9000 - 2 * TURN


def test_a_reboot_forgets_the_turns_in_extended_mode_too(host: Host) -> None:
    host.write(XM, "operating_mode", EXTENDED)
    place(host, 9000)
    host.ask(XM, 0x08)
    host.wait(0.5)
    assert position(host) == 9000 - 2 * TURN
    place(host, 9000 + TURN)
    host.world.set_supply(0.0)
    host.world.set_supply(12.0)
    host.wait(0.5)
    assert position(host) == 9000 - 2 * TURN


@pytest.mark.parametrize("offset", [-1024, -300, 700, 1024])
def test_a_homing_offset_is_added_behind_the_turns(host: Host, offset: int) -> None:
    place(host, 100)
    host.write(XM, "homing_offset", offset)
    assert position(host) == 100 + offset
    host.write(XM, "torque_enable", 1)
    assert position(host) == host.read(XM, "goal_position") == 100 + offset
    host.write(XM, "goal_position", 1500)
    host.wait(2.0)
    assert position(host) == pytest.approx(1500, abs=2)
    raw = host.shaft(XM).position * TURN / 2.0 / math.pi + MIDDLE
    assert raw == pytest.approx(1500 - offset, abs=2)


@pytest.mark.parametrize("offset", [-1025, 1025, 100_000])
def test_position_mode_ignores_a_homing_offset_beyond_1024(host: Host, offset: int) -> None:
    place(host, 100)
    assert host.write(XM, "homing_offset", offset) == OK
    assert host.read(XM, "homing_offset") == offset
    assert position(host) == 100
    host.write(XM, "operating_mode", EXTENDED)
    assert position(host) == 100 + offset
    host.write(XM, "operating_mode", POSITION)
    assert position(host) == 100


def test_reverse_mode_mirrors_the_position_but_not_the_homing_offset(host: Host) -> None:
    place(host, 3000)
    host.write(XM, "drive_mode", 1)
    assert position(host) == TURN - 3000
    host.write(XM, "homing_offset", 100)
    assert position(host) == TURN - 3000 + 100
    host.write(XM, "torque_enable", 1)
    host.write(XM, "goal_position", 1000)
    host.wait(2.0)
    assert position(host) == pytest.approx(1000, abs=2)


@pytest.mark.parametrize("mode", [POSITION, EXTENDED])
@pytest.mark.parametrize("counts", [-1000, 1, 3000, 4095, 9000])
def test_reverse_adds_no_turn(host: Host, mode: int, counts: int) -> None:
    place(host, counts)
    host.write(XM, "operating_mode", VELOCITY)
    host.write(XM, "operating_mode", mode)
    straight = position(host)
    assert 0 <= straight < TURN
    host.write(XM, "drive_mode", 1)
    assert position(host) == TURN - straight
    host.ask(XM, 0x08)
    host.wait(0.5)
    assert position(host) == TURN - straight
    host.write(XM, "drive_mode", 0)
    assert position(host) == straight


def test_at_the_end_of_a_turn_reverse_stays_within_it(host: Host) -> None:
    place(host, 0)
    host.write(XM, "drive_mode", 1)
    assert position(host) == 0
