"""Finding a gait of a robot."""

from pathlib import Path

import pytest

from tests.shapes import ONE_LEG, write_shape
from windup.hal.errors import UsageError
from windup.robots import load_robot
from windup.tools.assembly.gaits import gait_path


def test_a_file_that_is_not_there_is_told_to_a_robot_without_gaits(tmp_path: Path) -> None:
    folder = write_shape(tmp_path / "r", ONE_LEG)
    (folder / "gaits" / "nod.toml").unlink()
    with pytest.raises(UsageError, match=r"^no file wlak\.toml; one_leg has no gaits of its own$"):
        gait_path(load_robot(folder), "wlak.toml")
