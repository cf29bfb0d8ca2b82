"""A human that puts its feet where it is told, with torques from whole-body control."""

from pathlib import Path

import numpy as np
import pytest

from tests.tools.conftest import Windup
from windup.control.footprints.footprints import read_footprints
from windup.robots import RobotDescription
from windup.tools.behaviours.directed import build_checks, feet_of


def test_the_human_puts_a_foot_where_it_is_told(shell: Windup) -> None:
    where = ("--to", "0.2", "0.2", "--yaw", "15", "--duration", "0.5")
    ran = shell("step", "human", "--foot", "left", *where, "--json", "-")
    (fall,) = ran.json["falls"]
    assert (ran.status, ran.json["good"], ran.json["reason"]) == (0, True, "done")
    assert np.hypot(fall["place"]["x"] - 0.2, fall["place"]["y"] - 0.2) < 0.03
    assert fall["place"]["yaw_deg"] == pytest.approx(15.0, abs=5.0)


def test_the_humans_example_turns_round_within_reach(human: RobotDescription) -> None:
    path = Path(__file__).parents[3] / "docs" / "turn_left_human.toml"
    prints = read_footprints(path, feet_of(human))
    build_checks(human).check(prints)
    assert sum(np.degrees(one.place[2]) for one in prints) == pytest.approx(90.0)
