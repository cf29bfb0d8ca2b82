"""Whatever is broken: nothing is raised, and mistakes are found where a robot cannot be loaded."""

import random
from pathlib import Path

import pytest

from tests.shapes import ARM, QUADRUPED, write_shape
from windup.hal.errors import WindupError
from windup.robots import load_robot
from windup.robots.inspection.reading import read_folder
from windup.tools.benches.fuzz.broken_mjcf import broken_mjcf
from windup.tools.benches.fuzz.broken_toml import broken_toml


def loads(folder: Path) -> bool:
    try:
        load_robot(folder)
    except WindupError:
        return False
    return True


@pytest.mark.parametrize("file", ["robot.toml", "model.xml"])
@pytest.mark.parametrize("seed", range(40))
def test_what_cannot_be_loaded_has_mistakes_and_what_can_has_none(
    tmp_path: Path, file: str, seed: int
) -> None:
    rng = random.Random(seed)
    folder = write_shape(tmp_path / "r", rng.choice((ARM, QUADRUPED)))
    path = folder / file
    breaks = broken_toml if file == "robot.toml" else broken_mjcf
    path.write_text(breaks(rng, path.read_text()), encoding="utf-8")
    reading = read_folder(folder)
    assert loads(folder) == (not reading.mistakes)
    assert all("\n" not in line for line in reading.mistakes)
