import mujoco
import numpy as np
import pytest

from windup.hal.families import servo_model, servo_names
from windup.tools.benches import servo as bench_servo

SHEET = bench_servo.measure_servos("op3")


def test_the_bench_measures_every_row_of_the_data_sheet() -> None:
    assert list(SHEET) == [f"XM430-W350 at {volts} V" for volts in ("11.1", "12", "14.8")]


@pytest.mark.parametrize("row", SHEET)
def test_stall_torque_and_no_load_speed_are_the_data_sheets_within_5_percent(row: str) -> None:
    assert SHEET[row]["stall_torque"] == pytest.approx(1.0, abs=0.05)
    assert SHEET[row]["no_load_speed"] == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("row", SHEET)
def test_static_deflection_is_the_p_laws_within_3_percent(row: str) -> None:
    assert SHEET[row]["deflection"] == pytest.approx(1.0, abs=0.03)


@pytest.mark.parametrize("name", servo_names())
@pytest.mark.parametrize("voltage", [11.1, 7.0])
@pytest.mark.parametrize("goal", [0.05, -0.4, 3.0], ids=["linear", "both", "saturated"])
def test_a_servo_is_a_voltage_driven_motor_behind_a_p_law(
    name: str, voltage: float, goal: float
) -> None:
    servo = servo_model(name)
    stand = bench_servo.TestStand(servo, voltage)
    motor, gain = servo.motor(voltage), servo.error_gain * servo.p_default
    data = mujoco.MjData(stand.model)
    data.ctrl[0] = goal
    saturated = 0
    for _ in range(300):
        q, dq = float(data.qpos[0]), float(data.qvel[0])
        mujoco.mj_step(stand.model, data)
        duty = np.clip(gain * (goal - q), -servo.pwm_limit, servo.pwm_limit)
        torque = motor.K / motor.R * (duty * voltage - motor.K * dq)
        assert data.actuator_force[0] == pytest.approx(torque, abs=1e-12)
        saturated += abs(duty) == servo.pwm_limit
    assert abs(data.qpos[0]) > 0.0
    assert (saturated > 0) == (abs(goal) * gain > servo.pwm_limit)


def test_a_motor_by_hand_turns_as_the_dcmotor_does() -> None:
    servo = servo_model("XM430-W350")
    stand = bench_servo.TestStand(servo, 12.0)
    stand.model.dof_frictionloss[:] = 0.0  # the hand integrates no dry friction
    inertia = 0.01 + servo.armature
    motor, gain = servo.motor(12.0), servo.error_gain * servo.p_default
    data = mujoco.MjData(stand.model)
    data.ctrl[0] = 1.0
    # The same motor in steps a hundred times smaller.
    q, dq, h = 0.0, 0.0, 1e-5
    for tick in range(300):
        mujoco.mj_step(stand.model, data)
        for _ in range(100):
            duty = np.clip(gain * (1.0 - q), -1.0, 1.0)
            dq += h * motor.K / motor.R * (duty * 12.0 - motor.K * dq) / inertia
            q += h * dq
        if tick % 50 == 49:
            assert data.qpos[0] == pytest.approx(q, abs=0.01)
    assert q > 0.9, "it got there"
