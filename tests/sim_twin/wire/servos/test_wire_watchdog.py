"""What the Bus Watchdog does in each operating mode, over the wire, on the virtual clock."""

from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host import Host, open_host
from windup.sim_twin.wire.servos.register_file import BAD_RANGE, OK

XM = 1
CURRENT, VELOCITY, POSITION, EXTENDED, CURRENT_POSITION, PWM = 0, 1, 3, 4, 5, 16
POSITION_MODES = [POSITION, EXTENDED, CURRENT_POSITION]
OPEN_LOOP = [(CURRENT, "goal_current", 200), (PWM, "goal_pwm", 300)]


@pytest.fixture
def host() -> Iterator[Host]:
    with open_host("twin://bench?servos=XM430-W350:1&return_delay=0") as host:
        yield host


def move(host: Host, mode: int, goal: str, value: int) -> None:
    """Be on the way with a watchdog of 100 ms."""
    assert host.write(XM, "operating_mode", mode) == OK
    assert host.write(XM, "torque_enable", 1) == OK
    assert host.write(XM, "bus_watchdog", 5) == OK
    assert host.write(XM, goal, value) == OK


def test_it_trips_only_when_no_instruction_came_for_its_time(host: Host) -> None:
    move(host, VELOCITY, "goal_velocity", 100)
    for _ in range(20):
        host.wait(0.09)
        assert host.read(XM, "bus_watchdog") == 5
    host.wait(0.12)
    assert host.read(XM, "bus_watchdog") == -1


def test_it_sleeps_while_torque_is_off(host: Host) -> None:
    host.write(XM, "bus_watchdog", 1)
    host.wait(1.0)
    assert host.read(XM, "bus_watchdog") == 1


@pytest.mark.parametrize("mode", POSITION_MODES)
def test_position_modes_hold_where_it_tripped(host: Host, mode: int) -> None:
    assert host.write(XM, "profile_velocity", 50) == OK
    move(host, mode, "goal_position", 4000)
    host.wait(0.2)
    held = host.read(XM, "goal_position")
    assert 2048 < held < 2300  # on the way, and not where it was sent
    host.shaft(XM).load = 0.3
    host.wait(1.0)
    assert host.servo(XM).driving and host.read(XM, "torque_enable") == 1
    assert host.read(XM, "profile_velocity") == 0
    assert host.read(XM, "present_position") == pytest.approx(held, abs=20)
    assert host.shaft(XM).torque == pytest.approx(-0.3, abs=0.05)


def test_velocity_mode_brakes_to_a_standstill_and_stays_driven(host: Host) -> None:
    move(host, VELOCITY, "goal_velocity", 100)
    host.wait(1.0)
    assert host.servo(XM).driving and host.read(XM, "goal_velocity") == 0
    host.shaft(XM).load = 0.3
    host.wait(1.0)
    assert abs(host.shaft(XM).velocity) < 0.05
    assert host.shaft(XM).torque == pytest.approx(-0.3, abs=0.05)


@pytest.mark.parametrize(("mode", "goal", "value"), OPEN_LOOP)
def test_current_and_pwm_mode_let_go(host: Host, mode: int, goal: str, value: int) -> None:
    move(host, mode, goal, value)
    host.wait(0.2)
    assert not host.servo(XM).driving and host.read(XM, "torque_enable") == 1
    assert host.read(XM, goal) == 0
    shaft = host.shaft(XM)
    before, shaft.velocity, shaft.load = shaft.position, 0.0, -0.3
    host.wait(0.5)
    assert shaft.torque == 0.0 and shaft.position < before


@pytest.mark.parametrize(
    ("mode", "goal", "value"),
    [
        *((mode, "goal_position", 3000) for mode in POSITION_MODES),
        (VELOCITY, "goal_velocity", 150),
        *OPEN_LOOP,
    ],
)
def test_goals_are_refused_until_it_is_cleared_and_followed_then(
    host: Host, mode: int, goal: str, value: int
) -> None:
    move(host, mode, goal, value)
    host.wait(0.2)
    kept = host.read(XM, goal)
    assert host.write(XM, goal, value) == BAD_RANGE
    assert host.write(XM, "bus_watchdog", 5) == BAD_RANGE
    assert host.write(XM, "bus_watchdog", 0) == OK
    host.wait(0.5)
    assert host.read(XM, goal) == kept != value
    host.shaft(XM).blocked = mode == CURRENT  # a free shaft would soon be too fast for it
    assert host.write(XM, goal, value) == OK
    host.wait(2.0)
    assert host.servo(XM).driving
    present = goal.replace("goal", "present")
    assert host.read(XM, present) == pytest.approx(value, abs=max(3, 0.05 * value))


def test_torque_goes_off_and_on_while_it_is_tripped(host: Host) -> None:
    move(host, POSITION, "goal_position", 3000)
    host.wait(0.2)
    assert host.write(XM, "torque_enable", 0) == OK
    assert not host.servo(XM).driving
    assert host.read(XM, "bus_watchdog") == -1
    assert host.write(XM, "torque_enable", 1) == OK
    assert host.servo(XM).driving
