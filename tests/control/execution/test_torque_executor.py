"""Takeover and timing of torques; `tests/control/stepping/test_human_steps.py` has the human."""

from dataclasses import replace

import numpy as np
import pytest

from windup.control.execution.motion import Motion, Shift
from windup.control.execution.swing import gaussian_progress
from windup.control.execution.torque_executor import TAKE, TorqueExecutor
from windup.hal.command import JointCommand
from windup.hal.observation import BaseState, JointState, Observation
from windup.robots import load_robot
from windup.tools.assembly.torques import find_whole_body, torque_executor

HUMAN = load_robot("human")
STANCE = HUMAN.poses["ready"]
TICK = 0.001


def seen(time: float = 0.0, height: float = 1.0) -> Observation:
    zeros = np.zeros(len(STANCE))
    joints = JointState(STANCE.copy(), zeros, zeros, zeros, zeros, zeros)
    base = BaseState(np.array([0.0, 0.0, height]), np.eye(4)[0], np.zeros(3), np.zeros(3))
    return Observation(time, joints, None, np.zeros(len(HUMAN.contacts.names)), base)


@pytest.fixture
def executor() -> TorqueExecutor:
    return torque_executor(HUMAN, STANCE)


def standing(executor: TorqueExecutor) -> Motion:
    planted, com = executor.feet.planted(), executor.weight
    shift = Shift(com, executor.home(planted), 0.0, 0.5, gaussian_progress)
    return Motion(planted, shift)


def ticked(executor: TorqueExecutor, observation: Observation) -> tuple[bool, JointCommand]:
    executor.observe(observation)
    due = executor.due(observation.time, TICK)
    return due, executor.realise(standing(executor), observation.time, TICK)


def test_the_optimisation_runs_at_its_own_period(executor: TorqueExecutor) -> None:
    executor.reset(seen())
    due = [ticked(executor, seen(tick * TICK))[0] for tick in range(11)]
    assert [tick for tick, now in enumerate(due) if now] == [0, 5, 10]


def test_the_feet_are_beside_each_other_and_the_weight_comes_between_them(
    executor: TorqueExecutor,
) -> None:
    executor.reset(seen())
    homes = executor.feet.homes
    assert (homes[0] - homes[1])[:2] == pytest.approx([0.0, 0.167], abs=1e-3)
    assert executor.home(executor.feet.planted())[1] == pytest.approx(0.0, abs=1e-6)
    assert executor.over(0)[1] > 0.05


def test_after_a_takeover_the_height_of_the_stance_is_reached_gradually(
    executor: TorqueExecutor,
) -> None:
    observation = seen()
    executor.reset(observation)
    lowest = executor.feet.ground(0)[:, 2].min()
    standing_height = executor.feet.momenta.com[2] - lowest
    assert executor.feet.height == pytest.approx(standing_height, abs=1e-6)
    knees = [HUMAN.joints.names.index(name) for name in ("l_knee", "r_knee")]
    bent = replace(observation, joints=replace(observation.joints, position=STANCE.copy()))
    bent.joints.position[knees] += 0.3
    executor.take(bent)
    _, at_once = ticked(executor, bent)
    later = replace(bent, time=TAKE)
    _, afterwards = ticked(executor, later)
    # Extending the knees lifts the body: a torque toward smaller angles.
    assert (afterwards.torque[knees] < at_once.torque[knees]).all()


def test_the_gains_of_the_human_are_in_its_file() -> None:
    how = find_whole_body(HUMAN)
    assert (how.torque, how.weights.stance, how.com.stiffness) == (300.0, 1000.0, 40.0)
