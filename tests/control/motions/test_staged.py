from pathlib import Path

import numpy as np
import pytest

from tests.small_world import CONTACTS, JOINTS, N, gait, observation
from windup.control.motions.staged import StagedPlayer
from windup.hal.errors import ConfigError, StateMissingError
from windup.hal.joints import Array

GRAPH = """
title = "Bows and comes up"
loop = false
tries = 2
[[state]]
name = "bow"
pose = { waist = 40 }
move = 0.2
until = { time = 0.3 }
[[state]]
name = "up"
move = 0.2
until = { time = 0.2 }
reach = { joints = 5, within = 0.1, again = "bow" }
"""
DT = 0.01


def player_of(tmp_path: Path, text: str = GRAPH) -> StagedPlayer:
    player = StagedPlayer(gait(tmp_path, text), JOINTS, CONTACTS)
    player.reset(observation())
    return player


def waists(player: StagedPlayer, seconds: float, stuck: float | None = None) -> Array:
    """Return the waist's goals, degrees; it follows at once, or is stuck at an angle, degrees."""
    goals: list[float] = []
    position = np.zeros(N)
    for tick in range(round(seconds / DT)):
        if stuck is not None:
            position[0] = np.radians(stuck)
        command = player.step(observation(DT * tick, position.copy()), DT)
        position = command.position.copy()
        goals.append(float(np.degrees(command.position[0])))
    return np.array(goals)


def test_goals_glide_to_each_pose_and_back_and_the_graph_is_finished(tmp_path: Path) -> None:
    player = player_of(tmp_path)
    way = waists(player, 0.6)
    assert way[9] == pytest.approx(20.0), "half way at half time"
    np.testing.assert_allclose(way[19:30], 40.0)
    assert way[49] == pytest.approx(0.0)
    assert np.abs(np.diff(way)).max() < 1.6 * 40.0 * DT / 0.2
    assert player.finished
    assert (player.failed, player.retries) == (None, 0)


def test_what_is_not_reached_is_tried_again_from_where_the_file_says(tmp_path: Path) -> None:
    player = player_of(tmp_path)
    waists(player, 0.65, stuck=7.0)
    assert not player.finished
    way = waists(player, 0.6)
    assert player.retries == 1
    assert way.max() == pytest.approx(40.0), "it bows again"
    assert player.finished


def test_it_is_given_up_with_one_line_and_the_goals_stay(tmp_path: Path) -> None:
    player = player_of(tmp_path)
    waists(player, 1.3, stuck=7.0)
    assert player.failed == (
        "'up' was tried 2 times and not reached: waist is 7.0 degrees from its goal (5 is fine)"
    )
    assert not player.finished
    assert np.ptp(waists(player, 0.3, stuck=0.0)) == 0.0


def test_a_condition_that_comes_true_in_time_is_enough(tmp_path: Path) -> None:
    player = player_of(tmp_path)
    waists(player, 0.52, stuck=7.0)
    waists(player, 0.05)
    assert player.finished
    assert player.retries == 0


def test_reset_begins_anew(tmp_path: Path) -> None:
    player = player_of(tmp_path)
    waists(player, 1.3, stuck=7.0)
    player.reset(observation())
    assert player.failed is None
    waists(player, 0.6)
    assert player.finished


def test_an_attitude_that_nobody_measures_is_refused_before_anything_moves(tmp_path: Path) -> None:
    with pytest.raises(StateMissingError, match="attitude"):
        player_of(tmp_path, GRAPH.replace("joints = 5", "side = 5"))


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        (
            "move = 0.2\nuntil = { time = 0.3 }",
            "move = 0.4\nuntil = { time = 0.3 }",
            "0.4 s do not",
        ),
        ("{ time = 0.3 }", '{ contact = "left_foot" }', "state.bow.until: beside `move`"),
        ('again = "bow"', 'again = "bwo"', "did you mean 'bow'?"),
        ("tries = 2", "tries = 0", "tries: Expected `int` >= 1"),
        ("loop = false", "mirror = true", "without balance and mirror"),
    ],
    ids=["too long", "contact", "again", "tries", "mirror"],
)
def test_a_graph_that_cannot_be_is_refused(
    tmp_path: Path, before: str, after: str, message: str
) -> None:
    assert before in GRAPH
    with pytest.raises(ConfigError, match=message.replace("?", r"\?")):
        gait(tmp_path, GRAPH.replace(before, after))
