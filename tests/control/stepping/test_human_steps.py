import json
from pathlib import Path

import pytest

from windup.tools.cli import run


@pytest.mark.parametrize(
    ("impulse", "direction", "steps"), [("10", "0", 0), ("40", "0", 1), ("50", "90", 1)]
)
def test_the_human_steps_where_a_push_asks_for_it(
    tmp_path: Path, impulse: str, direction: str, steps: int
) -> None:
    out = tmp_path / "push.json"
    line = ["push", "human", "--impulse", impulse, "--direction", direction, "--at", "0.1"]
    assert run([*line, "--json", str(out)]) == 0
    row = json.loads(out.read_text())
    assert row["survived"]
    assert row["steps"] == steps


def test_the_human_comes_back_to_its_stance(tmp_path: Path) -> None:
    out = tmp_path / "push.json"
    line = ["push", "human", "--impulse", "30", "--at", "0.1", "--json", str(out)]
    assert run(line) == 0
    row = json.loads(out.read_text())
    assert (row["steps"], row["comfort_steps"]) == (1, 1)
    assert row["astray_m"] < 0.03


def test_feet_alone_do_not_survive_what_a_step_does() -> None:
    assert run(["push", "human", "--impulse", "40", "--at", "0.1", "--way", "feet"]) == 1


def test_the_human_steps_on_its_own_sensors_with_torques_that_come_late() -> None:
    line = ["push", "human", "--impulse", "25", "--at", "0.1"]
    assert run([*line, "--state", "estimated", "--delay", "0.01"]) == 0
