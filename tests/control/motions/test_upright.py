from pathlib import Path

import numpy as np
import pytest

from tests.small_world import CONTACTS, JOINTS, N, gait, observation
from windup.control.motions.staged import StagedPlayer
from windup.control.motions.upright import UprightFeedback
from windup.control.pose_graph.gait_file import Upright
from windup.hal.errors import ConfigError, StateMissingError
from windup.hal.joints import Array
from windup.hal.observation import BaseState, Observation

STATES = ("down", "up")


def leaning(
    pitch: float, roll: float = 0.0, rates: tuple[float, float] = (0.0, 0.0)
) -> Observation:
    """Return a base that leans forward or to the right, degrees, with its roll and pitch rates."""
    axis = np.radians([roll, pitch, 0.0])
    angle = float(np.linalg.norm(axis))
    unit = axis / angle if angle else axis
    turned = np.array([np.cos(angle / 2), *(np.sin(angle / 2) * unit)])
    turning = np.radians([*rates, 0.0])
    return observation(base=BaseState(np.zeros(3), turned, np.zeros(3), turning))


def change(table: Upright, seen: Observation, state: int = 0) -> Array:
    feedback = UprightFeedback(table, JOINTS, STATES)
    changed: Array = np.degrees(feedback.apply(np.zeros(N), seen, state)).round(6)
    return changed


def test_each_joint_leans_against_the_lean_and_its_rate() -> None:
    table = Upright(
        forward={"waist": -2.0, "l_hip": 0.5},
        forward_rate={"waist": -0.1},
        right={"r_hip": 1.0},
        right_rate={"r_hip": 0.2},
    )
    np.testing.assert_allclose(change(table, leaning(4.0)), [-8, 2, 0, 0, 0])
    np.testing.assert_allclose(change(table, leaning(4.0, rates=(0, 10))), [-9, 2, 0, 0, 0])
    np.testing.assert_allclose(change(table, leaning(0.0, 6.0, (10, 0))), [0, 0, 0, 8, 0])


def test_no_goal_is_changed_by_more_than_the_limit_or_past_a_joint_s_own() -> None:
    table = Upright(forward={"waist": 5.0, "l_knee": -1.0}, limit=7.0)
    np.testing.assert_allclose(change(table, leaning(20.0)), [7, 0, 0, 0, 0])


def test_states_that_are_not_named_are_left_alone() -> None:
    table = Upright(forward={"waist": 1.0}, states=["up"])
    assert change(table, leaning(5.0), state=0)[0] == 0.0
    assert change(table, leaning(5.0), state=1)[0] == pytest.approx(5.0)


GRAPH = """
title = "Stands"
loop = false
[upright]
forward = { waist = 2 }
[[state]]
name = "stand"
until = { time = 0.5 }
"""


def test_a_played_graph_balances_and_goes_on_from_its_own_goals(tmp_path: Path) -> None:
    player = StagedPlayer(gait(tmp_path, GRAPH), JOINTS, CONTACTS)
    player.reset(leaning(0.0))
    pushed = player.step(leaning(5.0), 0.01)
    assert np.degrees(pushed.position[0]) == pytest.approx(10.0)
    assert player.step(leaning(0.0), 0.01).position[0] == pytest.approx(0.0)


def test_a_robot_that_does_not_know_its_base_is_refused(tmp_path: Path) -> None:
    player = StagedPlayer(gait(tmp_path, GRAPH), JOINTS, CONTACTS)
    with pytest.raises(StateMissingError, match="needs the base state"):
        player.reset(observation())


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("waist = 2", "waits = 2", "upright.forward: unknown joint 'waits'; did you mean 'waist'"),
        ("forward =", 'states = ["sit"]\nforward =', "upright.states: unknown state 'sit'"),
    ],
    ids=["joint", "state"],
)
def test_a_table_that_names_what_is_not_there_is_refused(
    tmp_path: Path, before: str, after: str, message: str
) -> None:
    with pytest.raises(ConfigError, match=message):
        gait(tmp_path, GRAPH.replace(before, after))
