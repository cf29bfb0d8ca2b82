import json
from pathlib import Path

import pytest

from tests.tools.conftest import Windup


def test_op3_walks_from_its_library_on_one_rollout_a_step(shell: Windup) -> None:
    line = "walk op3 --model library --speed 0.15 --steps 8 --json -"
    ran = shell(*line.split())
    assert ran.status == 0
    assert ran.json["rollouts"] == ran.json["steps"] + 1  # the step that begins as the walk ends
    assert ran.json["step_model"]["sampled"] == 0


def test_a_walk_adds_its_models_to_a_file(shell: Windup, tmp_path: Path) -> None:
    path = tmp_path / "mine.models.json"
    sizes = []
    for speed in ("0", "0.1"):
        line = ["walk", "op3", "--speed", speed, "--steps", "6", "--learn", str(path)]
        assert shell(*line).status == 0
        sizes.append(path.read_text().count("jacobian"))
    assert 0 < sizes[0] <= sizes[1]
    file = json.loads(path.read_text())
    assert file["commands"] == [f"windup walk op3 --speed {at} --steps 6" for at in ("0.0", "0.1")]
    assert file["rate_hz"] == 250.0


@pytest.mark.parametrize("option", [["--seeds", "2"], ["--realtime"], ["--model", "frozen"]])
def test_learning_where_nothing_is_learnt_is_refused(
    shell: Windup, tmp_path: Path, option: list[str]
) -> None:
    ran = shell("walk", "op3", *option, "--learn", str(tmp_path / "x.json"))
    assert ran.status == 2
    assert "--learn" in ran.err
