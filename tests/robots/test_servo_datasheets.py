import numpy as np
import pytest

from windup.hal.errors import UnknownNameError
from windup.hal.families import servo_model, servo_names
from windup.hal.servos.servo_model import RPM

VOLTS = (9.6, 11.1, 12.0, 13.0, 16.8)


def test_a_row_of_the_data_sheet_comes_back_as_printed() -> None:
    motor = servo_model("XM430-W350").motor(12.0)
    assert motor.stall_torque == 4.1
    assert motor.no_load_speed == pytest.approx(46.0 * RPM)


def test_between_two_rows_the_motor_is_linear() -> None:
    motor = servo_model("XM430-W350").motor(11.55)
    assert motor.stall_torque == pytest.approx((3.8 + 4.1) / 2)
    assert motor.no_load_speed == pytest.approx((43 + 46) / 2 * RPM)


@pytest.mark.parametrize(("volt", "row"), [(5.55, 3.8), (29.6, 4.8)])
def test_outside_the_rows_torque_and_speed_follow_the_voltage(volt: float, row: float) -> None:
    motor = servo_model("XM430-W350").motor(volt)
    nearest = servo_model("XM430-W350").motor(11.1 if volt < 11.1 else 14.8)
    assert motor.stall_torque == pytest.approx(row * volt / nearest.voltage)
    np.testing.assert_allclose((motor.K, motor.R), (nearest.K, nearest.R))


def test_op3_servo_has_the_stiffness_and_damping_of_its_manual() -> None:
    servo = servo_model("XM430-W350")
    assert servo.error_gain == pytest.approx(0.00575476, rel=1e-5)
    assert servo.stiffness(800, 12.0) == pytest.approx(18.9, abs=0.05)
    assert servo.damping(12.0) == pytest.approx(0.851, abs=5e-4)
    assert servo.torque_constant == pytest.approx(1.79, abs=0.01)


def test_feetech_gain_is_the_one_the_oscilloscope_saw() -> None:
    assert servo_model("STS3215-7.4V").error_gain == pytest.approx(0.166, rel=0.02)


@pytest.mark.parametrize("name", servo_names())
@pytest.mark.parametrize("volt", VOLTS)
def test_the_motor_law_and_the_data_sheet_agree(name: str, volt: float) -> None:
    servo = servo_model(name)
    motor = servo.motor(volt)
    assert motor.K * volt / motor.R == pytest.approx(motor.stall_torque)
    assert servo.damping(volt) == pytest.approx(motor.K**2 / motor.R)
    duty_per_rad = servo.error_gain * servo.p_default
    stiffness = servo.stiffness(servo.p_default, volt)
    assert stiffness == pytest.approx(duty_per_rad * volt * motor.K / motor.R)
    assert servo.p_register(stiffness, volt) == pytest.approx(servo.p_default)


@pytest.mark.parametrize("name", servo_names())
def test_every_table_rises_with_the_voltage(name: str) -> None:
    rows = servo_model(name).rows
    for key in ("voltage", "stall_torque", "no_load_speed"):
        assert np.all(np.diff([getattr(row, key) for row in rows]) > 0.0)


def test_an_unknown_servo_names_the_likely_one() -> None:
    with pytest.raises(
        UnknownNameError, match=r"unknown servo 'XM430-W35'; did you mean 'XM430-W3"
    ):
        servo_model("XM430-W35")
