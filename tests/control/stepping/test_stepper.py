"""The stepper with observations that somebody makes up; `windup push` shows it on a robot."""

from dataclasses import replace

import numpy as np
import pytest

from tests.control.execution.test_footing import OP3, STANCE, seen
from windup.control.execution.servo_executor import ServoExecutor
from windup.control.stepping.comfort import ComfortStep
from windup.control.stepping.step_decision import find_rule
from windup.control.stepping.stepper import Stepper
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.tools.assembly.stepping import build_stepper, find_stepping, footing_of

TICK = 0.004


def stepper(way: str = "predictive") -> Stepper:
    made = build_stepper(OP3, way, STANCE)
    assert isinstance(made, Stepper)
    return made


def at(time: float, drift: float) -> Observation:
    return replace(seen(drift=drift), time=time)


def test_who_stands_still_stays_as_it_is() -> None:
    robot = stepper()
    robot.reset(at(0.0, 0.0))
    command = robot.step(at(TICK, 0.0), TICK)
    assert robot.phase == "stand"
    assert (
        np.abs(command.position - STANCE).max() < 0.08
    )  # the base is drawn over the middle of the feet
    assert np.all(command.stiffness == OP3.joints.stiffness)


def test_a_fast_fall_lifts_a_foot_at_once_and_puts_it_down_in_time() -> None:
    robot = stepper()
    robot.reset(at(0.0, 0.0))
    command = robot.step(at(TICK, 1.0), TICK)
    assert (robot.phase, robot.steps) == ("swing", 1)
    knees = [OP3.joints.names.index(name) for name in ("l_knee", "r_knee")]
    bent: Array = np.abs(command.position[knees]) - np.abs(STANCE[knees])
    assert bent.max() > 0.1
    landed = 0.0
    while robot.phase == "swing":
        landed += TICK
        robot.step(at(TICK + landed, 1.0), TICK)
    assert landed == pytest.approx(find_stepping(OP3).duration, abs=0.15)


def test_feet_alone_never_step() -> None:
    robot = stepper("feet")
    robot.reset(at(0.0, 0.0))
    robot.step(at(TICK, 1.0), TICK)
    assert (robot.phase, robot.steps) == ("stand", 0)


def test_balance_with_the_feet_draws_the_base_against_the_fall() -> None:
    robot = stepper("feet")
    robot.reset(at(0.0, 0.0))
    still = robot.step(at(TICK, 0.0), TICK).position
    falling = robot.step(at(2 * TICK, 0.2), TICK).position
    ankle = OP3.joints.names.index("l_ank_pitch")
    # The ankle's axis points to the right: less of it presses on the toes.
    assert falling[ankle] < still[ankle] - 0.02


def test_a_robot_with_its_own_dampings_uses_them() -> None:
    stepping = find_stepping(OP3)
    assert stepping.find_rule("predictive").when == stepping.rule["predictive"].when
    assert stepping.find_rule("capture") == find_rule("capture")


def test_feet_astray_come_back_by_a_comfort_step() -> None:
    stepping = find_stepping(OP3)
    executor = ServoExecutor(OP3.joints, footing_of(OP3, STANCE), STANCE, stepping)
    robot = Stepper(executor, find_rule("capture"), stepping)
    observation = at(0.0, 0.0)
    hips = [OP3.joints.names.index(name) for name in ("l_hip_pitch", "r_hip_pitch")]
    observation.joints.position[hips] += [-0.15, -0.15]  # left forward, right back
    robot.reset(observation)
    time = 0.0
    while robot.phase == "stand" and time < 2.0:
        time += TICK
        robot.step(replace(observation, time=time), TICK)
    assert (robot.phase, robot.comforts, robot.steps) == ("comfort", 1, 0)
    assert time == pytest.approx(find_stepping(OP3).patience, abs=2 * TICK)


def test_a_turned_foot_is_turned_back() -> None:
    robot = stepper()
    observation = at(0.0, 0.0)
    observation.joints.position[OP3.joints.names.index("r_hip_yaw")] += 0.4
    robot.reset(observation)
    comfort = ComfortStep(robot.executor, 0.0, find_stepping(OP3))
    assert comfort.needed
    assert abs(robot.executor.feet.planted().front) == pytest.approx(0.2, abs=0.02)


def test_a_base_that_is_turned_comes_back_to_where_the_feet_point() -> None:
    robot = stepper()
    observation = at(0.0, 0.0)
    hips = [OP3.joints.names.index(name) for name in ("l_hip_yaw", "r_hip_yaw")]
    observation.joints.position[hips] += 0.3
    robot.reset(observation)
    goals = robot.step(replace(observation, time=TICK), TICK).position
    assert goals[hips] == pytest.approx(STANCE[hips], abs=0.05)


def test_the_foot_in_the_air_faces_as_the_trunk_will_when_it_turns() -> None:
    robot, turning = stepper(), at(0.0, 1.0)
    assert turning.base is not None
    base = replace(turning.base, angular_velocity=np.array([0.0, 0.0, 3.0]))
    turning = replace(turning, base=base)
    robot.reset(turning)
    for tick in range(1, 12):
        command = robot.step(replace(turning, time=tick * TICK), TICK)
    assert robot.phase == "swing"
    names = OP3.joints.names
    hip = names.index(("l_hip_yaw", "r_hip_yaw")[robot.stepping_foot])
    assert command.position[hip] == pytest.approx(STANCE[hip], abs=0.05)
