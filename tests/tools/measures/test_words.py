"""What is said of a run is true of it."""

import json
from typing import Any

import numpy as np
import pytest

from tests.tools.conftest import Windup
from windup.tools.behaviours.rise import lay
from windup.tools.behaviours.stand import format_stand
from windup.tools.measures.fall_report import format_fall
from windup.tools.measures.walk_text import format_walk
from windup.tools.robot.robot import Robot
from windup.tools.robot.stopping import LAY

STOOD: dict[str, Any] = {
    "robot": "op3",
    "fell": False,
    "reason": "done",
    "sim_time_s": 2.0,
    "first_motion_s": 0.0,
    "largest_error_deg": 1.04,
    "largest_error_joint": "l_knee",
}
WALKED: dict[str, Any] = {
    "robot": "op3",
    "fell": False,
    "reason": "done",
    "steps": 3,
    "steps_requested": 3,
    "speed_m_s": None,
    "distance_m": 0.02,
    "lateral_m": 0.0,
    "heading_deg": 0.0,
    "sim_time_s": 1.0,
    "wall_time_s": 0.1,
    "slipped": False,
    "catches": [],
    "foot_clearance_mm": None,
}
FALL: dict[str, Any] = {
    "torso_impact_m_s": 3.3,
    "head_impact_m_s": 0.0,
    "torso_knock_m_s": 1.0,
    "peak_joint": "l_knee",
}


def test_the_first_motion_is_no_part_of_a_stand() -> None:
    said = format_stand(STOOD | {"sim_time_s": 2.9, "first_motion_s": 0.9})
    assert said.startswith("op3 stood for 2.0 s, after a first motion of 0.9 s; farthest")
    assert format_stand(STOOD).startswith("op3 stood for 2.0 s; farthest from its pose is l_knee")


def test_a_stand_on_a_port_lasts_as_long_as_it_was_told(shell: Windup) -> None:
    ran = shell("stand", "op3", "--port", "twin://op3", "--seconds", "1", "--json", "-")
    assert ran.status == 0
    assert "op3 stood for 1.0 s, after a first motion of " in " ".join(ran.err.split())
    assert ran.json["first_motion_s"] > 0.3
    total = ran.json["first_motion_s"] + 1.0
    assert ran.json["sim_time_s"] == pytest.approx(total, abs=0.03)


def test_a_walk_too_short_for_a_speed_has_none() -> None:
    assert format_walk(WALKED).startswith("op3 walked 3 steps: 0.02 m forward, ")
    assert "None" not in format_walk(WALKED)
    assert format_walk(WALKED | {"speed_m_s": 0.2}).startswith("op3 walked 3 steps at 0.200 m/s: ")


def test_a_walk_that_did_not_begin_has_no_real_time() -> None:
    said = format_walk(WALKED | {"reason": LAY, "sim_time_s": 0.0, "wall_time_s": 0.0})
    assert said == "op3 did not walk: it was already lying down: put it on its feet"


@pytest.mark.parametrize("way", ["walk", "stand", "play"])
def test_one_that_lay_there_before_did_not_fall(way: str) -> None:
    with Robot.open("op3") as robot:
        lay(robot, "front")
        if way == "walk":
            assert str(robot.walk(steps=2)) == f"op3 did not walk: {LAY}"
        elif way == "stand":
            assert robot.stand(0.1).reason == LAY
        else:
            assert robot.play("wave").reason == LAY
        assert robot.loop.ticks == 0


def test_a_load_beyond_the_stall_torque_is_no_percentage_of_it() -> None:
    assert format_fall(FALL | {"peak_load": 0.85}).endswith("peak load 85 % of stall at l_knee")
    said = format_fall(FALL | {"peak_load": 1.86})
    assert said.endswith(
        "l_knee was loaded with 1.9 x its stall torque, more than its motor can produce"
    )


def test_every_seed_of_a_stand_is_a_row(shell: Windup) -> None:
    ran = shell("stand", "op3", "--seconds", "0.2", "--seeds", "2", "--noise", "3", "--json", "-")
    rows = json.loads(ran.out)["rows"]
    assert [row["seed"] for row in rows] == [0, 1]
    assert ran.err.count("op3 stood for") == 2
    assert ran.err.splitlines()[-1] == "2 of 2 seeds stood"


@pytest.mark.parametrize("port", [None, "twin://op3"])
def test_a_noisy_start_is_where_a_robot_stands_up_from(port: str | None) -> None:
    with Robot.open("op3", port=port, noise=3.0, seed=1) as robot:
        off = np.degrees(robot.backend.read().joints.position - robot.description.stance)
        assert 1.5 < np.std(off) < 4.5
        robot.stand(1.0)
        assert not robot.fallen
