import os
import shutil
import time
from pathlib import Path

import pytest

from windup.robots import load_robot
from windup.robots.folders import FOLDER


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return the folder of an op3 that was written a while ago."""
    copied = tmp_path / "op3"
    shutil.copytree(FOLDER / "op3", copied)
    for name in ("robot.toml", "model.xml"):
        age(copied / name, 100.0)
    return copied


def age(path: Path, seconds: float) -> None:
    os.utime(path, times=(time.time() - seconds,) * 2)


def change(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_a_robot_that_has_not_changed_is_compiled_once(folder: Path) -> None:
    assert load_robot(folder) is load_robot(folder)
    assert load_robot("op3").model is load_robot("op3").model


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("robot.toml", "rate_hz = 250.0", "rate_hz = 125.0"),
        ("model.xml", 'timestep="0.002"', 'timestep="0.001"'),
    ],
)
def test_a_file_that_was_changed_is_read_again(folder: Path, name: str, old: str, new: str) -> None:
    before = load_robot(folder)
    change(folder / name, old, new)
    after = load_robot(folder)
    assert (before.rate_hz, before.timestep) != (after.rate_hz, after.timestep)


def test_a_file_that_was_just_written_is_not_trusted_to_stay(folder: Path) -> None:
    age(folder / "robot.toml", 0.0)
    assert load_robot(folder) is not load_robot(folder)


def test_a_robot_with_other_files_is_read_each_time(folder: Path) -> None:
    change(folder / "model.xml", "<mujoco", "<!-- file -->\n<mujoco")
    age(folder / "model.xml", 100.0)
    assert load_robot(folder) is not load_robot(folder)


def test_a_relative_path_means_another_folder_elsewhere(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder.parent)
    here = load_robot("./op3")
    (folder.parent / "other").mkdir()
    shutil.copytree(folder, folder.parent / "other" / "op3")
    monkeypatch.chdir("other")
    assert load_robot("./op3") is not here


def test_the_shared_model_is_what_the_mjcf_compiles_to() -> None:
    robot = load_robot("duck")
    fresh = robot.spec().compile()
    assert robot.model.nsensor == fresh.nsensor
    assert (robot.model.body_pos == fresh.body_pos).all()
    assert (robot.model.body_inertia == fresh.body_inertia).all()
