from pathlib import Path

import numpy as np
import pytest

from tests.small_world import AIR, CONTACTS, JOINTS, L_TOE, N, gait, observation
from windup.control.motions.play import GraphPlayer, PoseHolder
from windup.hal.joints import Array
from windup.hal.publishing.controller_block import ControllerBlock
from windup.hal.publishing.run_state import RunState

GAIT = """
title = "Bow"
loop = false
[[state]]
name = "wait"
pose = { waist = 5 }
until = { contact = "left_foot" }
[[state]]
name = "bow"
pose = { waist = 30 }
until = { time = 0.02 }
[[state]]
name = "rest"
until = { time = 0.03 }
"""
DT = 0.01


def test_a_pose_is_reached_smoothly_from_where_the_joints_are() -> None:
    holder = PoseHolder(JOINTS, np.full(N, 0.8), ramp=0.5)
    holder.reset(observation(2.0, np.full(N, 0.4)))
    times = 2.0 + np.arange(0.0, 0.7, DT)
    way = np.array([holder.step(observation(t), DT).position[0] for t in times])
    assert way[0] == pytest.approx(0.4)
    np.testing.assert_allclose(way[times >= 2.5], 0.8)
    assert way[25] == pytest.approx(0.6), "half way at half time"
    assert np.diff(way).min() >= 0.0
    assert np.diff(way).max() < 1.6 * 0.4 * DT / 0.5


def test_without_a_ramp_the_pose_is_asked_for_at_once() -> None:
    holder = PoseHolder(JOINTS, np.full(N, 0.8), ramp=0.0)
    holder.reset(observation())
    np.testing.assert_array_equal(holder.step(observation(), DT).position, np.full(N, 0.8))


def waists(player: GraphPlayer, contacts: list[Array]) -> list[float]:
    commands = [
        player.step(observation(DT * i, contacts=felt), DT) for i, felt in enumerate(contacts)
    ]
    return [round(float(np.degrees(command.position[0])), 6) for command in commands]


def test_a_graph_is_played_to_its_end(tmp_path: Path) -> None:
    player = GraphPlayer(gait(tmp_path, GAIT), JOINTS, CONTACTS)
    player.reset(observation())
    assert waists(player, [AIR, AIR, L_TOE, AIR, AIR]) == [5, 5, 30, 30, 0]
    assert not player.finished
    assert waists(player, [AIR] * 4) == [0, 0, 0, 0]
    assert player.finished


def test_the_state_of_the_graph_is_published(tmp_path: Path) -> None:
    player = GraphPlayer(gait(tmp_path, GAIT), JOINTS, CONTACTS)
    player.reset(observation())
    block = ControllerBlock.of(player.published)
    waists(player, [AIR, AIR, L_TOE, AIR])
    player.publish(block)
    assert player.published.phases == ("wait", "bow", "rest")
    assert block.phase == 1
    assert block.phase_time == pytest.approx(2 * DT)
    assert block.run_state is RunState.STANDING


def test_reset_begins_at_the_first_state_again(tmp_path: Path) -> None:
    player = GraphPlayer(gait(tmp_path, GAIT), JOINTS, CONTACTS)
    player.reset(observation())
    waists(player, [AIR, L_TOE])
    player.reset(observation())
    assert waists(player, [AIR, AIR]) == [5, 5]
    assert not player.finished


def test_a_played_graph_has_the_robots_own_gains(tmp_path: Path) -> None:
    player = GraphPlayer(gait(tmp_path, GAIT), JOINTS, CONTACTS)
    player.reset(observation())
    command = player.step(observation(), DT)
    np.testing.assert_array_equal(command.stiffness, JOINTS.stiffness)
    np.testing.assert_array_equal(command.damping, JOINTS.damping)
