from pathlib import Path

import pytest

from tests.robots.test_robot_errors import MJCF, TOML
from windup.hal.errors import ConfigError
from windup.hal.guard import HealthKind
from windup.robots import load_robot


def hopper(folder: Path, safety: str) -> Path:
    (folder / "model.xml").write_text(MJCF)
    (folder / "robot.toml").write_text(f"{TOML}\n[safety]\n{safety}\n")
    return folder


def test_levels_of_the_file_are_those_of_its_joints(tmp_path: Path) -> None:
    robot = load_robot(hopper(tmp_path, "temperature = { warn = 50, stop = 60 }\nidle = 3.0"))
    assert robot.health.stop[HealthKind.TEMPERATURE].tolist() == [60.0, 60.0]
    assert robot.health.stop[HealthKind.LOAD].tolist() == [0.75, 0.75], "by default the servos' own"
    assert robot.safety.idle == 3.0


@pytest.mark.parametrize(
    ("safety", "message"),
    [
        (
            "temperature = { warn = 70, stop = 60 }",
            "safety.temperature: the warning at 70 would come after the stop at 60",
        ),
        (
            "supply_low = { warn = 10, stop = 11 }",
            "safety.supply_low: the warning at 10 would come after the stop at 11",
        ),
        (
            "supply_low = { warn = 12, stop = 10 }",
            "safety.supply_low: the warning at 12 V is not below drive.supply, 12 V",
        ),
        (
            "supply_high = { warn = 11, stop = 16 }",
            "safety.supply_high: the warning at 11 V is not above drive.supply, 12 V",
        ),
        ("load = { warn = 0.5 }", "missing: safety.load.stop"),
        ("load = { warn = 0.5, stop = inf }", "safety.load.stop"),
        ("temprature = { warn = 50, stop = 60 }", "did you mean 'temperature'?"),
    ],
)
def test_levels_that_cannot_be_are_said(tmp_path: Path, safety: str, message: str) -> None:
    with pytest.raises(ConfigError) as error:
        load_robot(hopper(tmp_path, safety))
    assert message in str(error.value)
