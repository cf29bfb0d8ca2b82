"""The strider on observations that somebody makes up; `windup stride` shows it on a robot."""

from dataclasses import replace

import numpy as np
import pytest

from tests.control.execution.test_footing import OP3, seen
from windup.control.stride.pendulum import VelocityCommand
from windup.control.stride.strider import Phase, Strider
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import ControllerBlock
from windup.hal.publishing.run_state import RunState
from windup.tools.assembly.state import state_of
from windup.tools.assembly.stepping import stepping_stance
from windup.tools.behaviours.directed import limbs_of
from windup.tools.behaviours.striding import find_stride

TICK = 0.004
HOW = find_stride(OP3)


def strider(order: VelocityCommand) -> Strider:
    state, stance = state_of(OP3), stepping_stance(OP3)
    return Strider(OP3.joints, state, limbs_of(OP3), stance, lambda _: order, HOW)


def play(robot: Strider, still: Observation, seconds: float) -> list[Phase]:
    """Let it believe that it stands still for so long; returns the phases."""
    phases: list[Phase] = []
    for tick in range(round(seconds / TICK)):
        robot.step(replace(still, time=tick * TICK), TICK)
        phases.append(robot.phase)
    return phases


def test_who_has_no_order_stands() -> None:
    robot, still = strider(VelocityCommand()), seen()
    robot.reset(still)
    assert set(play(robot, still, 1.0)) == {"stand"}
    assert robot.steps == 0


@pytest.mark.parametrize(("heading", "foot"), [(0.5 * np.pi, 0), (-0.5 * np.pi, 1)])
def test_the_foot_on_the_side_that_it_goes_to_steps_first(heading: float, foot: int) -> None:
    robot, still = strider(VelocityCommand(0.1, heading)), seen()
    robot.reset(still)
    phases = play(robot, still, HOW.begin + HOW.single + HOW.double - 0.02)
    assert list(dict.fromkeys(phases)) == ["shift", "swing", "land"]
    assert phases.count("swing") == pytest.approx(HOW.single / TICK, abs=2)
    robot, still = strider(VelocityCommand(0.1, heading)), seen()
    robot.reset(still)
    play(robot, still, HOW.begin + 0.3 * HOW.single)
    aim = robot.plan(HOW.begin + 0.3 * HOW.single, TICK)
    assert aim.flying == foot
    assert aim.right_load == float(1 - foot)
    assert robot.flying(foot).position[2] > 0.01


def test_a_sole_follows_the_ground_that_the_other_one_feels() -> None:
    robot, still = strider(VelocityCommand(0.1)), seen()
    robot.reset(still)
    ankle = [OP3.joints.names.index(f"{side}_ank_pitch") for side in "lr"]
    still.joints.position[ankle] += np.array([0.05, -0.05])  # both soles tilt alike
    play(robot, still, HOW.begin + 0.9 * HOW.single)
    foot = 0 if robot.plan(HOW.begin + 0.9 * HOW.single, TICK).flying == 0 else 1
    tilt = robot.flying(foot).rotation[:, 2]
    assert 0.01 < abs(tilt[0]) < 0.06
    assert tilt[1] == pytest.approx(0.0, abs=0.01)


def test_the_phase_is_published() -> None:
    robot, still = strider(VelocityCommand(0.1)), seen()
    robot.reset(still)
    block = ControllerBlock.of(robot.published)
    robot.publish(block)
    assert block.run_state is RunState.STANDING
    play(robot, still, HOW.begin + 0.5 * HOW.single)
    robot.publish(block)
    assert robot.published.phases[block.phase] == "swing"
    assert block.run_state.words == "walking"
