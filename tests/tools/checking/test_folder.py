"""Gaits, step models and the files beside robot.toml are checked with the robot."""

import shutil
from pathlib import Path

import pytest

from tests.shapes import ARM, QUADRUPED, THIRTY, write_shape
from windup.robots import load_robot, robot_names
from windup.tools.checking.findings import Findings
from windup.tools.checking.folder import inspect_folder


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def seen(folder: Path) -> Findings:
    return inspect_folder(folder).findings


@pytest.fixture
def my_op3(tmp_path: Path) -> Path:
    return Path(shutil.copytree(load_robot("op3").folder, tmp_path / "my_op3"))


@pytest.mark.parametrize("name", robot_names())
def test_robots_of_the_package_have_no_errors(name: str) -> None:
    assert seen(load_robot(name).folder).errors == []


def test_mistakes_of_all_files_are_found_at_once(my_op3: Path) -> None:
    edit(my_op3 / "gaits" / "wave.toml", "title", "titel")
    edit(my_op3 / "gaits" / "squat.toml", "start = ", 'start = "nowhere"\n#')
    edit(my_op3 / "stepping.toml", 'way = "', 'way = "jump_')
    edit(my_op3 / "stride.toml", 'stance = "', 'stance = "no_')
    edit(my_op3 / "footprints.toml", "hold = ", "hold = -")
    (my_op3 / "gaits" / "sit.toml").write_text("state = [")
    said = seen(my_op3).errors
    begins = (
        "gaits/sit.toml: not TOML: ",
        "gaits/squat.toml: start: unknown pose 'nowhere'; known: ",
        "gaits/wave.toml: titel: unknown key; did you mean 'title'?",
        "gaits/wave.toml: title: is missing",
        "stepping.toml: way: unknown way 'jump_",
        "stride.toml: stance: unknown pose 'no_",
        "footprints.toml: hold: Expected `float` >= 0.0",
    )
    assert len(said) == len(begins)
    assert all(line.startswith(begin) for line, begin in zip(said, begins, strict=True)), said


def test_step_models_of_another_gait_are_an_error(my_op3: Path) -> None:
    edit(my_op3 / "gaits" / "walk.toml", "title = ", "source = 'changed'\ntitle = ")
    said = seen(my_op3).errors
    assert len(said) == 1
    assert said[0].startswith("gaits/walk.models.json: learnt for another version of the gait")


def test_a_walk_takes_as_many_perturbations_as_variables(my_op3: Path) -> None:
    walk = my_op3 / "gaits" / "walk.toml"
    edit(walk, "[balance]\n", '[balance]\nregulation = ["up"]\n#')
    text = walk.read_text()
    begin = text.index("regulation = [", text.index('regulation = ["up"]') + 5)
    walk.write_text(text[:begin] + "# " + text[begin:])
    assert "regulation variables; give as many" in "\n".join(seen(my_op3).errors)


def test_step_models_without_a_gait_are_doubted(my_op3: Path) -> None:
    (my_op3 / "gaits" / "walk.toml").rename(my_op3 / "gaits" / "stroll.toml")
    warnings = seen(my_op3).warnings
    assert warnings == ["gaits/walk.models.json: there is no gait walk.toml beside it"]


def test_gaits_of_a_robot_that_cannot_be_read_have_their_keys_checked(tmp_path: Path) -> None:
    folder = write_shape(tmp_path / "r", ARM)
    edit(folder / "robot.toml", 'torso = "trunk"', 'torso = "trnk"')
    edit(folder / "gaits" / "nod.toml", "loop", "lop")
    found = seen(folder)
    assert [line.partition(": ")[0] for line in found.errors] == ["robot.toml", "gaits/nod.toml"]
    assert any("gaits are checked against joints" in note for note in found.notes)


@pytest.mark.parametrize("name", ["steping.toml", "Robot.toml", "gait"])
def test_a_name_that_is_nearly_one_of_ours_is_doubted(tmp_path: Path, name: str) -> None:
    folder = write_shape(tmp_path / "r", ARM)
    if name.endswith(".toml"):
        (folder / name).touch()
    else:
        (folder / name).mkdir()
    (folder / "meshes").mkdir()
    warnings = seen(folder).warnings
    assert len(warnings) == 1
    assert warnings[0].startswith(f"{name}: Windup reads no such file (did you mean ")


def test_what_is_added_and_assumed_is_noted(tmp_path: Path) -> None:
    notes = "\n".join(seen(write_shape(tmp_path / "r", THIRTY)).notes)
    assert "are added to the twin: accelerometer, gyro, left_touch, right_touch" in notes
    assert "no gait called walk" in notes


def test_what_cannot_walk_is_noted(tmp_path: Path) -> None:
    notes = "\n".join(seen(write_shape(tmp_path / "r", QUADRUPED)).notes)
    assert "cannot walk: that takes two feet" in notes
