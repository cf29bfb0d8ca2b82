"""A robot's folder is read as far as it can be, and each of its mistakes is named."""

from pathlib import Path

import pytest

from tests.shapes import ARM, QUADRUPED, write_shape
from windup.hal.errors import ConfigError
from windup.robots import load_robot, robot_names
from windup.robots.inspection.reading import read_folder


def edited(folder: Path, changes: dict[str, list[tuple[str, str]]]) -> Path:
    """Write a quadruped with some words of its files changed."""
    write_shape(folder, QUADRUPED)
    for name, pairs in changes.items():
        text = (folder / name).read_text()
        for old, new in pairs:
            assert old in text
            text = text.replace(old, new, 1)
        (folder / name).write_text(text)
    return folder


@pytest.mark.parametrize("name", robot_names())
def test_a_robot_of_the_package_has_no_mistake(name: str) -> None:
    reading = read_folder(load_robot(name).folder)
    assert reading.mistakes == ()
    assert reading.robot is not None and reading.robot.name == name


def test_all_mistakes_of_robot_toml_are_found_at_once(tmp_path: Path) -> None:
    toml = [
        ("rate_hz = 125", "rate_hz = 300"),
        ('base = "trunk"', 'base = "trnk"'),
        ('name = "front_left_0", id = 1,', 'name = "front_left_0", id = 2,'),
        ("upper = 1.5 },\n", "upper = 9.5 },\n"),
        ('site = "front_left_sole"', 'site = "sole"'),
        ("[poses.stand]", "[poses.stand]\nknee = 1.0\nhind_left_0 = 2.0"),
        ('stance = "stand"', 'stance = "stnd"'),
    ]
    reading = read_folder(edited(tmp_path / "r", {"robot.toml": toml}))
    said = "\n".join(reading.mistakes)
    for words in (
        "rate_hz: a period of 1/300 s is not a whole number of physics steps",
        "base: unknown body 'trnk'; did you mean 'trunk'?",
        "joint 'front_left_1': has id 2, which 'front_left_0' already has",
        "joint 'front_left_0': -1.5 to 9.5 rad is wider than the MJCF's -1.5 to 1.5 rad",
        "joint 'front_left_0': lower -1.5 to upper 9.5 rad (ratio 1, zero 2048) is",
        "foot 'front_left': site: unknown site 'sole'",
        "poses.stand: unknown joint 'knee'",
        "poses.stand.hind_left_0: 2 rad is outside -1.5 to 1.5 rad",
        "stance: unknown pose 'stnd'; did you mean 'stand'?",
    ):
        assert f"robot.toml: {words}" in said
    assert len(reading.mistakes) == 9
    assert reading.robot is None and reading.model is not None


def test_what_load_robot_says_first_counts_the_others(tmp_path: Path) -> None:
    toml = [('base = "trunk"', 'base = "trnk"'), ('torso = "trunk"', 'torso = "trnk"')]
    folder = edited(tmp_path / "my robot", {"robot.toml": toml})
    with pytest.raises(ConfigError) as error:
        load_robot(folder)
    assert str(error.value).endswith(f"; 1 more: run `windup check '{folder}'`")


def test_an_unknown_key_hides_nothing_else(tmp_path: Path) -> None:
    toml = [("rate_hz", "colour = 3\nrate_hz"), ('torso = "trunk"', 'torso = "trnk"')]
    reading = read_folder(edited(tmp_path / "r", {"robot.toml": toml}))
    first, second = reading.mistakes
    assert first.startswith("robot.toml: colour: unknown key")
    assert second.startswith("robot.toml: torso: unknown body 'trnk'")


def test_a_robot_with_nothing_wrong_but_unknown_keys_can_be_looked_at(tmp_path: Path) -> None:
    folder = edited(tmp_path / "r", {"robot.toml": [("rate_hz", "colour = 3\nrate_hz")]})
    reading = read_folder(folder)
    assert len(reading.mistakes) == 1 and reading.robot is not None


@pytest.mark.filterwarnings("ignore:Inertia matrix")
def test_mistakes_of_the_mjcf_are_told_beside_those_of_the_keys(tmp_path: Path) -> None:
    changes = {
        "robot.toml": [("rate_hz = 125", 'rate_hz = "fast"'), ("tilt = 1.0", "tilt = nan")],
        "model.xml": [('mass="0.4"', 'mass="1e300"'), ('armature="0.01"', 'armature="-1"')],
    }
    reading = read_folder(edited(tmp_path / "r", changes))
    assert [line.partition(": ")[0] for line in reading.mistakes] == [
        "robot.toml",
        "robot.toml",
        *["model.xml"] * (len(reading.mistakes) - 2),
    ]
    said = "\n".join(reading.mistakes)
    assert "robot.toml: rate_hz: Expected `float`, got `str`" in said
    assert "robot.toml: fall.tilt: nan is not finite" in said
    assert "model.xml: joint 'front_left_0', armature: -1 is negative" in said
    assert "model.xml: body 'trunk', mass: 1e+300 is not finite, or huge" in said
    assert (reading.file, reading.model, reading.robot) == (None, None, None)


@pytest.mark.parametrize("text", ["joint = [", 'name = "a"\nname = "b"'])
def test_what_is_not_toml_leaves_the_mjcf(tmp_path: Path, text: str) -> None:
    folder = write_shape(tmp_path / "r", ARM)
    (folder / "robot.toml").write_text(text)
    reading = read_folder(folder)
    assert len(reading.mistakes) == 1
    assert reading.mistakes[0].startswith("robot.toml: not TOML: ")
    assert reading.model is not None


def test_joints_whose_limits_are_the_mjcfs_are_told(tmp_path: Path) -> None:
    limits = ("id = 1, lower = -1.5, upper = 1.5", "id = 1")
    reading = read_folder(edited(tmp_path / "r", {"robot.toml": [limits]}))
    assert reading.unlimited == ("front_left_0",)
