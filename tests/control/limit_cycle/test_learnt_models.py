import json
from pathlib import Path

import numpy as np
import pytest

from tests.control.limit_cycle.test_step_memory import HERE, TARGET, J, Steps, model
from windup.control.limit_cycle.learnt_models import LearntModels
from windup.hal.errors import ConfigError

NAMES = ["up.forward", "up.lateral"], ["a", "b"], "0123456789abcdef"


def learnt(*places: float, complete: bool = True) -> LearntModels:
    models = LearntModels(complete=complete)
    for place in places:
        models.store(0, np.array([place, 0.0]), (1.0 + place) * J)
    return models


def with_model(**changed: object) -> str:
    model = {"phase": 0, "start": [0.0], "jacobian": [[1.0, 0.0], [0.0, 1.0]], **changed}
    file = {"regulation": NAMES[0], "perturbations": NAMES[1], "models": [model], "gait": NAMES[2]}
    return json.dumps(file)


def test_starts_within_reach_share_the_mean_of_their_models() -> None:
    models = learnt(0.0, 0.01)
    assert models.recall(0, np.zeros(2)) == pytest.approx(1.005 * J)


def test_the_nearest_model_serves_however_far_it_is() -> None:
    assert learnt(0.0, 0.1).recall(0, np.array([3.0, 0.0])) == pytest.approx(1.1 * J)


def test_while_it_learns_it_lends_nothing() -> None:
    assert learnt(0.0, complete=False).recall(0, np.zeros(2)) is None


def test_a_part_of_the_graph_without_a_model_is_sampled() -> None:
    assert learnt(0.0).recall(1, np.zeros(2)) is None


def test_from_the_first_step_on_one_rollout_reaches_the_target() -> None:
    steps, memory = Steps(), LearntModels(complete=True)
    memory.store(0, HERE, J)
    found = model(memory).control(steps, TARGET, 0, HERE)
    assert steps.rollouts == 1
    assert steps(found[None])[0][0] == pytest.approx(TARGET, abs=1e-6)


def test_the_rest_of_a_step_has_models_of_its_own() -> None:
    steps, memory = Steps(), LearntModels()
    model(memory).control(steps, TARGET, 0, HERE, at=2)
    memory.complete = True
    assert memory.recall(2, HERE) is not None
    assert memory.recall(0, HERE) is None


def test_what_is_written_is_read_again(tmp_path: Path) -> None:
    path = tmp_path / "walk.models.json"
    models = learnt(0.0, 0.1)
    models.commands.append("windup walk op3 --speed 0.1")
    path.write_text(models.file(*NAMES, rate_hz=125.0).text())
    again = LearntModels(complete=True)
    again.read(path, *NAMES)
    assert again.recall(0, np.array([0.09, 0.0])) == pytest.approx(1.1 * J)
    assert again.file(*NAMES, rate_hz=125.0) == models.file(*NAMES, rate_hz=125.0)


def test_a_file_has_one_model_a_line_and_says_how_it_was_made() -> None:
    models = learnt(0.0, 0.1, 0.2)
    models.commands.append("windup walk op3 --speed 0.1")
    lines = models.file(*NAMES, rate_hz=125.0).text().splitlines()
    assert sum(line.startswith(' {"phase":0,') for line in lines) == 3
    assert lines[1:4] == [
        '"gait": "0123456789abcdef",',
        '"commands": ["windup walk op3 --speed 0.1"],',
        '"rate_hz": 125.0,',
    ]
    assert json.loads("".join(lines))["models"][2]["start"] == [0.2, 0.0]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[", "no file of step models"),
        ('{"regulation":["up.forward"],"perturbations":["a"],"models":[]}', "Learn them anew"),
        (with_model(jacobian=[[1.0], [2.0]]), r"models\[0\].jacobian: give 2 x 2 numbers"),
        (
            with_model(start=[1e300]),
            r"models\[0\].start\[0\]: 1e\+300 is too large \(maximum 1e\+12",
        ),
        (with_model(phase=-1), "Expected `int` >= 0"),
    ],
)
def test_another_file_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "walk.models.json"
    path.write_text(text)
    with pytest.raises(ConfigError, match=message):
        LearntModels().read(path, *NAMES)
