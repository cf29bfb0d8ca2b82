"""Every mistake of a gait is named, each with its key."""

from pathlib import Path

from tests.small_world import CONTACTS, JOINTS, MIRROR
from windup.control.pose_graph.gait_file import GaitFile
from windup.control.pose_graph.gait_mistakes import gait_mistakes
from windup.hal.config import load_toml
from windup.hal.errors import ConfigError
from windup.hal.joints import Array

BROKEN = """
title = "Broken"
[pose]
l_knee = 10
[[state]]
name = "one"
pose = { l_hip = 90, r_hip = -80, waist = 3 }
until = { contact = "left_hand" }
next = "three"
stance = "tail"
[[state]]
name = "two"
pose = { l_kne = 3 }
until = {}
[[perturbation]]
name = "lean"
pose = { neck = 1 }
[[perturbation]]
name = "sway"
states = ["four"]
pose = { waist = 1 }
[balance]
regulation = ["up.forward"]
perturbations = ["laen"]
"""

RIGHT = """
title = "Right"
mirror = true
[[state]]
name = "one"
until = { time = 1 }
"""


def mistakes(folder: Path, text: str) -> list[str]:
    path = folder / "gait.toml"
    path.write_text(text)
    found = gait_mistakes(path, load_toml(path, GaitFile), JOINTS, CONTACTS, MIRROR)
    assert all(line.startswith(f"{path}: ") for line in found)
    return [line.removeprefix(f"{path}: ") for line in found]


def test_all_mistakes_are_found_at_once(tmp_path: Path) -> None:
    found = mistakes(tmp_path, BROKEN)
    begins = [
        "balance.perturbations: unknown perturbation 'laen'; did you mean 'lean'?",
        "state.one.until.contact: unknown contact 'left_hand'; did you mean 'left_foot'?",
        "state.one.next: unknown state 'three'",
        "state.one.stance: unknown foot 'tail'",
        "state.two.pose: unknown joint 'l_kne'; did you mean 'l_knee'?",
        "state.two.until: give either `time` or `contact`",
        "perturbation.lean: unknown joint 'neck'",
        "perturbation.sway.states: unknown state 'four'",
        "state.one.pose.l_hip: 90 degrees is outside the joint's limits -57.3 .. 57.3",
        "state.one.pose.r_hip: -80 degrees is outside the joint's limits -57.3 .. 57.3",
    ]
    assert len(found) == len(begins)
    for line, begin in zip(found, begins, strict=True):
        assert line.startswith(begin)


def test_a_right_gait_has_none(tmp_path: Path) -> None:
    assert mistakes(tmp_path, RIGHT) == []


def test_what_only_the_whole_graph_shows_is_found(tmp_path: Path) -> None:
    path = tmp_path / "gait.toml"
    path.write_text(RIGHT.replace('"one"', '"one"\nnext = "one"'))
    (line,) = gait_mistakes(path, load_toml(path, GaitFile), JOINTS, CONTACTS, MIRROR)
    assert "no state leads to one'" in line


def test_a_robot_without_a_mirror_image_is_a_mistake_of_the_gait(tmp_path: Path) -> None:
    def crooked(values: Array) -> Array:
        raise ConfigError("joint 'l_hip' has no partner")

    path = tmp_path / "gait.toml"
    path.write_text(RIGHT)
    found = gait_mistakes(path, load_toml(path, GaitFile), JOINTS, CONTACTS, crooked)
    assert found == [f"{path}: joint 'l_hip' has no partner"]


def test_a_graph_without_states_is_one_mistake(tmp_path: Path) -> None:
    found = mistakes(tmp_path, "title = 'a'\nstate = []")
    assert found == ["state: a graph needs at least one state"]
