"""When a servo protects itself, over the wire, on the virtual clock."""

from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host import Host, open_host
from windup.sim_twin.wire.servos.firmware import ALERT
from windup.sim_twin.wire.servos.health import ENCODER, INPUT_VOLTAGE, OVERHEATING, OVERLOAD
from windup.sim_twin.wire.servos.register_file import BAD_ACCESS, OK

XM = 1
POSITION, PWM = 3, 16


@pytest.fixture
def host() -> Iterator[Host]:
    with open_host("twin://bench?servos=XM430-W350:1&return_delay=0") as host:
        yield host


def turn_on(host: Host, mode: int) -> None:
    assert host.write(XM, "operating_mode", mode) == OK
    assert host.write(XM, "torque_enable", 1) == OK


def test_an_overload_shuts_down_until_a_reboot(host: Host) -> None:
    turn_on(host, POSITION)
    host.shaft(XM).blocked = True
    host.write(XM, "goal_position", 4000)
    host.wait(1.5)
    assert host.read(XM, "hardware_error_status") == OVERLOAD
    assert host.read(XM, "torque_enable") == 0
    assert host.write(XM, "torque_enable", 1) == ALERT | BAD_ACCESS
    assert host.ask(XM, 0x01)[0].parameters[0] == ALERT
    assert host.ask(XM, 0x08)[0].parameters == b"\0"
    assert host.ask(XM, 0x01) == []  # it boots
    host.wait(0.5)
    assert host.read(XM, "hardware_error_status") == 0
    assert host.write(XM, "torque_enable", 1) == OK


@pytest.mark.parametrize("error", [OVERHEATING, INPUT_VOLTAGE, ENCODER])
def test_only_errors_that_shutdown_names_take_the_torque(host: Host, error: int) -> None:
    turn_on(host, POSITION)
    health = host.servo(XM).firmware.health
    if error == OVERHEATING:
        health.temperature = 95.0
    elif error == INPUT_VOLTAGE:
        host.world.set_supply(9.0)
    else:
        health.inject(error)
        host.servo(XM).firmware.protect(host.now)
    host.wait(0.05)
    assert host.read(XM, "hardware_error_status") == error
    assert host.read(XM, "torque_enable") == int(error != OVERHEATING)


def test_heat_comes_from_current_and_goes(host: Host) -> None:
    host.write(XM, "shutdown", 0)
    turn_on(host, PWM)
    host.shaft(XM).blocked = True
    host.write(XM, "goal_pwm", 600)
    host.wait(20.0)
    warm = host.read(XM, "present_temperature")
    assert 28 < warm < 80
    host.write(XM, "goal_pwm", 0)
    host.wait(100.0)
    assert host.read(XM, "present_temperature") < warm
