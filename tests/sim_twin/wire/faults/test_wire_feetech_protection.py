"""How a Feetech servo feels its load and protects itself, over the wire, on the virtual clock."""

import math
from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host1 import PING, Host1, open_host1
from windup.sim_twin.wire.faults.fault_rule import make_rule
from windup.sim_twin.wire.servos.feetech_servo import CURRENT, OVERLOAD, TEMPERATURE, VOLTAGE


@pytest.fixture
def host() -> Iterator[Host1]:
    with open_host1("twin://bench?servos=STS3215-12V:1,STS3250:2") as host:
        yield host


def test_load_and_current_follow_the_torque(host: Host1) -> None:
    shaft = host.shaft(1)
    host.write(1, "torque_enable", 1)
    shaft.load = 0.5
    host.wait(1.0)
    servo = host.servo(1).loop
    assert host.read(1, "present_current") == pytest.approx(-0.5 / 1.0889 / 6.5e-3, rel=0.15)
    assert host.read(1, "present_load") == pytest.approx(-1000 * 0.5 / 2.94, rel=0.15)
    # duty = P e / 4000 of servos.toml
    error = shaft.position * servo.per_rad
    assert host.read(1, "present_load") == pytest.approx(-1000 * 32 * error / 4000, abs=3)


def test_the_torque_limit_caps_the_duty(host: Host1) -> None:
    host.write(1, "torque_limit", 200)
    host.shaft(1).load = 1.0
    host.write(1, "torque_enable", 1)
    host.wait(0.5)
    assert host.read(1, "present_load") == pytest.approx(-200, abs=3)


def test_torque_on_holds_the_present_pose_and_off_lets_go(host: Host1) -> None:
    host.place(1, 2600)
    host.write(1, "torque_enable", 1)
    assert host.read(1, "goal_position") == 2600
    host.wait(0.3)
    assert host.read(1, "present_position") == 2600
    host.write(1, "torque_enable", 0)
    host.shaft(1).load = 1.0
    host.wait(0.3)
    assert host.read(1, "present_position") > 2700


def test_an_overload_leaves_the_protective_torque_until_the_torque_is_switched_off(
    host: Host1,
) -> None:
    host.shaft(1).blocked = True
    host.write(1, "goal_position", 3500)
    host.wait(1.0)
    assert host.read(1, "present_load") > 900
    host.wait(1.5)
    assert host.ask(1, PING)[0].instruction == OVERLOAD
    assert host.read(1, "status") == OVERLOAD
    assert host.read(1, "torque_enable") == 1
    assert host.read(1, "present_load") == pytest.approx(200, abs=8)
    host.write(1, "goal_position", 3400)
    host.wait(0.05)
    assert host.read(1, "status") == OVERLOAD
    assert host.read(1, "present_load") == pytest.approx(200, abs=8)
    host.write(1, "torque_enable", 0)
    assert host.read(1, "status") == 0
    host.write(1, "goal_position", 3500)
    host.wait(0.5)
    assert host.read(1, "present_load") > 900


def test_without_its_unloading_condition_an_overload_is_only_shown(host: Host1) -> None:
    host.write(1, "unloading_condition", 44 & ~OVERLOAD)
    host.shaft(1).blocked = True
    host.write(1, "goal_position", 3500)
    host.wait(2.5)
    assert host.read(1, "status") == OVERLOAD
    assert host.read(1, "present_load") > 900


def test_heat_and_voltage_are_reported_and_heat_lets_go(host: Host1) -> None:
    host.write(1, "torque_enable", 1)
    host.servo(1).temperature = 75.0
    host.wait(0.05)
    assert host.ask(1, PING)[0].instruction == TEMPERATURE
    assert host.read(1, "torque_enable") == 0
    assert host.read(1, "present_temperature") == 75
    host.world.set_supply(15.0)
    host.wait(0.05)
    assert host.ask(2, PING)[0].instruction == VOLTAGE
    assert host.read(2, "present_voltage") == 150


def test_while_it_is_too_hot_no_goal_switches_the_torque_on(host: Host1) -> None:
    host.servo(1).heat(75.0)
    host.wait(0.05)
    host.write(1, "goal_position", 2100)
    assert host.read(1, "torque_enable") == 0
    host.write(1, "torque_enable", 1)
    assert host.read(1, "torque_enable") == 0
    assert not host.servo(1).driving
    host.servo(1).heat(-math.inf)
    host.servo(1).temperature = 40.0
    host.wait(0.05)
    host.write(1, "goal_position", 2100)
    assert host.read(1, "torque_enable") == 1


def test_too_much_current_stays_to_be_seen_until_the_torque_is_switched_off(host: Host1) -> None:
    host.write(1, "protection_current", 20)
    host.write(1, "overcurrent_time", 10)
    host.shaft(1).blocked = True
    host.write(1, "goal_position", 3500)
    host.wait(0.5)
    assert host.read(1, "status") == CURRENT
    assert host.read(1, "torque_enable") == 0
    host.write(1, "goal_position", 3400)
    assert host.read(1, "torque_enable") == 0
    host.write(1, "torque_enable", 0)
    assert host.read(1, "status") == 0
    host.write(1, "goal_position", 3400)
    assert host.read(1, "torque_enable") == 1


@pytest.mark.parametrize("power", ["brown_out", "reset"])
def test_after_losing_its_power_the_torque_is_off_until_the_next_goal(
    host: Host1, power: str
) -> None:
    host.write(1, "goal_position", 2100)
    host.wait(0.3)
    host.port.world.faults.add(make_rule(power, at=host.now))
    host.wait(0.5)
    assert host.read(1, "torque_enable") == 0
    assert not host.servo(1).driving
    host.write(1, "goal_position", 2200)
    assert host.read(1, "torque_enable") == 1
    assert host.servo(1).driving
