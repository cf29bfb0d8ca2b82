"""What a servo does, over the wire, on the virtual clock."""

from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host import Host, open_host
from windup.sim_twin.wire.servos.register_file import (
    BAD_ACCESS,
    BAD_INSTRUCTION,
    BAD_LIMIT,
    BAD_RANGE,
    FAILED,
    OK,
)

XM = 1
XL430 = 2
XL330 = 3
VELOCITY, POSITION, EXTENDED, CURRENT_POSITION, PWM, CURRENT = 1, 3, 4, 5, 16, 0


@pytest.fixture
def host() -> Iterator[Host]:
    with open_host("twin://bench?servos=XM430-W350:1,XL430:2,XL330:3&return_delay=0") as host:
        yield host


def turn_on(host: Host, mode: int, servo: int = XM) -> None:
    assert host.write(servo, "operating_mode", mode) == OK
    assert host.write(servo, "torque_enable", 1) == OK


def test_torque_locks_the_eeprom(host: Host) -> None:
    turn_on(host, POSITION)
    assert host.write(XM, "return_delay_time", 10) == BAD_ACCESS
    assert host.write(XM, "torque_enable", 0) == OK
    assert host.write(XM, "return_delay_time", 10) == OK


def test_torque_on_makes_the_present_position_the_goal(host: Host) -> None:
    host.write(XM, "goal_position", 3000)
    turn_on(host, POSITION)
    host.wait(0.5)
    assert host.read(XM, "goal_position") == host.read(XM, "present_position") == 2048


def test_a_goal_is_reached_and_reported(host: Host) -> None:
    turn_on(host, POSITION)
    host.write(XM, "goal_position", 3000)
    host.wait(0.1)
    assert host.read(XM, "moving") == 1
    assert host.read(XM, "present_velocity") > 100
    assert host.read(XM, "present_current") > 0
    host.wait(2.0)
    assert host.read(XM, "present_position") == pytest.approx(3000, abs=2)
    assert host.read(XM, "moving") == 0
    assert host.read(XM, "moving_status") & 0x01


def test_the_pwm_limit_caps_the_speed(host: Host) -> None:
    assert host.write(XM, "pwm_limit", 442) == OK
    turn_on(host, EXTENDED)
    host.write(XM, "goal_position", 40000)
    host.wait(1.0)
    free = host.servo(XM).firmware.loop.servo.motor(12.0).no_load_speed / 0.0239808
    assert host.read(XM, "present_velocity") == pytest.approx(0.5 * free, rel=0.03)
    assert host.read(XM, "present_pwm") == pytest.approx(442, abs=2)


@pytest.mark.parametrize(
    ("register", "value", "error"),
    [
        ("goal_position", 4096, BAD_LIMIT),
        ("goal_position", 300, BAD_LIMIT),
        ("goal_pwm", 600, BAD_LIMIT),
        ("goal_current", -101, BAD_LIMIT),
        ("goal_velocity", 201, BAD_LIMIT),
        ("operating_mode", 2, BAD_RANGE),
        ("bus_watchdog", -1, BAD_RANGE),
        ("min_position_limit", 4095, OK),
    ],
)
def test_limits(host: Host, register: str, value: int, error: int) -> None:
    for name, limit in (("min_position_limit", 500), ("pwm_limit", 500), ("current_limit", 100)):
        assert host.write(XM, name, limit) == OK
    assert host.write(XM, register, value) == error


def test_a_mode_that_the_model_lacks_is_refused(host: Host) -> None:
    assert host.write(XL430, "operating_mode", CURRENT) == BAD_RANGE
    assert host.write(XL330, "operating_mode", CURRENT) == OK


def test_a_change_of_mode_resets_gains_and_goals(host: Host) -> None:
    host.write(XM, "position_p_gain", 123)
    host.write(XM, "operating_mode", EXTENDED)
    assert host.read(XM, "position_p_gain") == 800
    host.write(XM, "pwm_limit", 600)
    host.write(XM, "current_limit", 500)
    host.write(XM, "profile_velocity", 50)
    for mode in (PWM, CURRENT, POSITION):
        assert host.write(XM, "operating_mode", mode) == OK
        assert host.read(XM, "goal_pwm") == 600
        assert host.read(XM, "goal_current") == 500
        assert host.read(XM, "profile_velocity") == 0


def test_a_mode_that_is_written_again_resets_nothing(host: Host) -> None:
    host.write(XM, "position_p_gain", 123)
    host.write(XM, "operating_mode", POSITION)
    assert host.read(XM, "position_p_gain") == 123


def test_power_up_sets_goal_pwm_and_goal_current_to_their_limits(host: Host) -> None:
    host.write(XM, "pwm_limit", 600)
    host.write(XM, "goal_pwm", 100)
    host.write(XM, "goal_current", 100)
    host.ask(XM, 0x08)
    host.wait(0.5)
    assert host.read(XM, "goal_pwm") == 600
    assert host.read(XM, "goal_current") == 1193


def test_without_torque_a_shaft_coasts_by_the_friction_of_its_gears(host: Host) -> None:
    turn_on(host, PWM)
    host.wait(1.0)
    shaft = host.shaft(XM)
    fast = shaft.velocity
    host.write(XM, "torque_enable", 0)
    began = host.now
    host.wait(0.5)
    assert host.read(XM, "present_current") == host.read(XM, "present_pwm") == 0
    slowed = fast - shaft.friction / shaft.inertia * (host.now - began)
    assert 0.0 < shaft.velocity == pytest.approx(slowed, rel=0.01)


def test_velocity_mode_holds_its_velocity_and_ramps_with_the_profile(host: Host) -> None:
    turn_on(host, VELOCITY)
    host.write(XM, "profile_acceleration", 10)  # 10 x 214.577 rev/min2: 35.8 rev/min a second
    host.write(XM, "goal_velocity", 150)
    host.wait(0.5)
    assert host.read(XM, "velocity_trajectory") == pytest.approx(78, abs=3)
    host.wait(3.0)
    assert host.read(XM, "present_velocity") == pytest.approx(150, abs=3)
    host.shaft(XM).load = -0.5
    host.wait(1.0)
    assert host.read(XM, "present_velocity") == pytest.approx(150, abs=5)


def test_pwm_mode_is_a_voltage_and_current_mode_a_torque(host: Host) -> None:
    turn_on(host, PWM)
    host.write(XM, "goal_pwm", -300)
    host.wait(1.0)
    shaft = host.shaft(XM)
    assert shaft.velocity == pytest.approx(-300 / 885 * 12.0 / shaft.constant, rel=0.03)
    host.write(XM, "torque_enable", 0)
    turn_on(host, CURRENT)
    shaft.blocked = True
    host.write(XM, "goal_current", 200)
    host.wait(0.1)
    sheet = host.servo(XM).firmware.loop.servo
    assert sheet.torque_constant is not None
    assert shaft.torque == pytest.approx(200 * 2.69e-3 * sheet.torque_constant)
    assert host.read(XM, "present_current") == 200


def test_current_based_position_mode_stops_at_its_current(host: Host) -> None:
    turn_on(host, CURRENT_POSITION)
    host.shaft(XM).blocked = True
    host.write(XM, "goal_current", 100)
    host.write(XM, "goal_position", 4000)
    host.wait(0.1)
    assert host.read(XM, "present_current") == 100


def test_load_is_reported_where_no_current_is_sensed(host: Host) -> None:
    turn_on(host, PWM, XL430)
    host.shaft(XL430).blocked = True
    host.write(XL430, "goal_pwm", 442)
    host.wait(0.05)
    assert host.read(XL430, "present_current") == pytest.approx(500, abs=2)  # 0.1 %


def test_a_profile_takes_the_time_that_the_manual_gives(host: Host) -> None:
    turn_on(host, POSITION)
    host.write(XM, "profile_velocity", 80)
    host.write(XM, "profile_acceleration", 20)
    began = host.now
    host.write(XM, "goal_position", 3048)
    top, rate = 80 * 0.229 / 60.0, 20 * 214.577 / 3600.0  # turns a second, and squared
    seconds = 1000 / 4096 / top + top / rate
    host.wait(began + 0.5 * seconds - host.now)
    assert host.read(XM, "position_trajectory") == pytest.approx(2548, abs=8)
    assert host.read(XM, "moving_status") >> 4 & 3 == 3  # trapezoidal
    assert host.read(XM, "moving_status") & 0x02
    host.wait(began + seconds - host.now - 0.02)
    assert host.read(XM, "moving_status") & 0x02
    host.wait(0.04)
    assert not host.read(XM, "moving_status") & 0x02
    assert host.read(XM, "position_trajectory") == 3048


def test_a_time_based_profile_takes_its_milliseconds(host: Host) -> None:
    host.write(XM, "drive_mode", 0x04)
    turn_on(host, POSITION)
    host.write(XM, "profile_velocity", 2000)
    host.write(XM, "profile_acceleration", 500)
    began = host.now
    host.write(XM, "goal_position", 3048)
    host.wait(began + 1.0 - host.now)
    assert host.read(XM, "position_trajectory") == pytest.approx(2548, abs=8)
    host.wait(began + 2.01 - host.now)
    assert host.read(XM, "position_trajectory") == 3048


def test_torque_on_by_goal_update(host: Host) -> None:
    host.write(XM, "drive_mode", 0x08)
    host.write(XM, "goal_position", 2500)
    assert host.read(XM, "torque_enable") == 1
    host.wait(2.0)
    assert host.read(XM, "present_position") == pytest.approx(2500, abs=2)


def test_a_reboot_keeps_the_eeprom_and_resets_the_ram(host: Host) -> None:
    host.write(XM, "return_delay_time", 20)
    host.write(XM, "position_p_gain", 300)
    host.write(XM, "indirect_address_168", 116)
    host.ask(XM, 0x08)
    host.wait(0.5)
    assert host.read(XM, "return_delay_time") == 20
    assert host.read(XM, "position_p_gain") == 800
    assert host.read(XM, "indirect_address_168") == 224


@pytest.mark.parametrize(
    ("option", "identifier", "baud_code"), [(0xFF, 1, 1), (0x01, 3, 1), (0x02, 3, 3)]
)
def test_a_factory_reset_keeps_what_its_option_says(
    host: Host, option: int, identifier: int, baud_code: int
) -> None:
    registers = host.servo(XL330).registers
    host.write(XL330, "max_position_limit", 3000)
    assert host.ask(XL330, 0x06, bytes((option,)))[0].parameters == b"\0"
    assert registers.get("id") == identifier
    assert registers.get("baud_rate") == baud_code
    assert registers.get("max_position_limit") == 4095


def test_nobody_resets_a_whole_bus_by_broadcast(host: Host) -> None:
    host.ask(254, 0x06, b"\xff")
    assert [device.identifier for device in host.world.devices] == [1, 2, 3]


def test_a_registered_write_waits_for_the_action(host: Host) -> None:
    turn_on(host, POSITION)
    assert host.ask(XM, 0x05)[0].parameters == bytes((BAD_INSTRUCTION,))
    assert host.ask(XM, 0x04, bytes((116, 0, 0, 9, 0, 0)))[0].parameters == b"\0"
    assert host.read(XM, "registered_instruction") == 1
    assert host.read(XM, "goal_position") == 2048
    assert host.ask(XM, 0x05)[0].parameters == b"\0"
    assert host.read(XM, "goal_position") == 0x0900
    assert host.read(XM, "registered_instruction") == 0


def test_clear_forgets_the_turns_but_not_in_motion(host: Host) -> None:
    turn_on(host, EXTENDED)
    host.write(XM, "goal_position", 9000)
    host.wait(0.5)
    assert host.ask(XM, 0x10, b"\x01DXL\x22")[0].parameters == bytes((FAILED,))
    host.wait(4.0)
    assert host.ask(XM, 0x10, b"\x01DXL\x22")[0].parameters == b"\0"
    assert 0 <= host.read(XM, "present_position") < 4096


def test_an_unknown_instruction_and_an_empty_address_are_errors(host: Host) -> None:
    assert host.ask(XM, 0x77)[0].parameters == bytes((BAD_INSTRUCTION,))
    assert host.ask(XM, 0x02, bytes((0x90, 1, 4, 0)))[0].parameters == bytes((BAD_ACCESS,))
