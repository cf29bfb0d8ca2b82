"""`windup synthesise`: genes, gait files, objective, search, and the command itself."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.tools.conftest import Windup
from windup.control.pose_graph.gait_file import GaitFile
from windup.hal.config import load_toml
from windup.hal.errors import UnknownNameError, UsageError
from windup.robots import load_robot
from windup.robots.folders import robot_names
from windup.tools.assembly.gaits import find_gait, gait_path
from windup.tools.synthesis.gait_toml import write_gait
from windup.tools.synthesis.genes import Gene, Genome
from windup.tools.synthesis.log import Entry, SearchLog
from windup.tools.synthesis.score import objective
from windup.tools.synthesis.search import Search, Values

ROW: dict[str, Any] = {
    "steps": 30,
    "steps_requested": 40,
    "reason": "fell",
    "distance_m": 2.0,
    "lateral_m": -0.5,
    "heading_deg": 45.0,
    "speed_m_s": 0.5,
    "foot_clearance_mm": -10.0,
    "flights": 10,
    "skips": 0.8,
    "flight_time_s": 1.0,
    "sim_time_s": 10.0,
    "cost_of_transport": np.e - 1.0,
    "shake_rad_s": 0.7,
}
GENES = [Gene("pose.S1.knee", 10.0, 4.0, 0.0, 20.0), Gene("hold.S1", 0.2, 0.02, 0.0, 2.0)]


def genome(robot: str, gait: str) -> Genome:
    found = load_robot(robot)
    file = load_toml(gait_path(found, gait), GaitFile)
    return Genome(file, found.joints, found.mirror)


@pytest.mark.parametrize("robot", robot_names())
def test_a_gait_file_says_the_same_when_it_is_written_again(robot: str, tmp_path: Path) -> None:
    for name, path in load_robot(robot).gaits().items():
        file = load_toml(path, GaitFile)
        write_gait(tmp_path / f"{name}.toml", file)
        assert load_toml(tmp_path / f"{name}.toml", GaitFile) == file


def test_a_graph_of_two_halves_stays_so(tmp_path: Path) -> None:
    human = genome("human", "walk")
    assert "pose.S1.l_knee" in human.genes
    assert "pose.S4.l_knee" not in human.genes
    write_gait(
        tmp_path / "new.toml",
        human.express({"pose.S1.l_knee": 66.0, "pose.S1.l_hip_roll": 2.0, "hold.S2": 0.25}),
    )
    robot = load_robot("human")
    new, old = find_gait(robot, str(tmp_path / "new.toml")).graph, find_gait(robot, "walk").graph
    roll = robot.joints.names.index("r_hip_roll")
    assert new.pose[3, robot.joints.names.index("r_knee")] == pytest.approx(np.radians(66.0))
    assert new.pose[3, roll] == pytest.approx(robot.mirror(new.pose[0])[roll])
    assert new.pose[3, roll] != old.pose[3, roll]
    np.testing.assert_allclose(new.hold[[1, 4]], 0.25)


def test_targets_limits_and_perturbations_are_genes_too() -> None:
    file = genome("robobird", "run").express(
        {
            "target.up.forward": -0.1,
            "limit.stance_hip_roll": 20.0,
            "change.stance_hip_pitch.l_hip_pitch": 0.8,
        }
    )
    assert file.balance is not None
    assert file.balance.targets["up.forward"] == -0.1
    assert {item.name: item.limit for item in file.perturbation}["stance_hip_roll"] == 20.0
    assert file.perturbation[0].pose == {"l_hip_pitch": 0.8}


def test_genes_are_chosen_by_name_and_the_usual_ones_leave_still_joints_alone() -> None:
    bird = genome("robobird", "run")
    assert [gene.name for gene in bird.choose(["hold.*"])] == ["hold.S2"]
    usual = {gene.name for gene in bird.choose()}
    assert {"pose.S1.r_knee1", "hold.S2", "target.up.forward"} <= usual
    assert not {"pose.S1.neck", "limit.stance_hip_pitch"} & usual
    with pytest.raises(UsageError, match=r"did you mean 'pose\.S1\.l_knee\d'"):
        bird.choose(["pose.S1.l_knee"])


def test_a_gene_stays_within_the_limits_of_its_joint() -> None:
    assert [GENES[0].round(value) for value in (-3.0, 7.123456, 99.0)] == [0.0, 7.12, 20.0]


@pytest.mark.parametrize(
    ("term", "value"),
    {
        "falls=4": 4.0 * 0.25,
        "speed=2": 2.0 * 0.5,
        "effort": 1.0,
        "shake=10": 7.0,
        "drift=1": 0.75,
        "flight": 1.0 - 10 / 29,
        "air": 0.5,
        "cross": 0.5,
        "skip": 0.2,
    }.items(),
)
def test_the_terms_of_the_objective(term: str, value: float) -> None:
    assert objective((term,), 1.0).cost([ROW, ROW]) == pytest.approx(value)


def test_an_objective_that_cannot_be_is_refused() -> None:
    with pytest.raises(UnknownNameError, match="did you mean 'effort'"):
        objective(("efort",), None)
    with pytest.raises(UsageError, match="say which with --aim"):
        objective(("speed",), None)
    with pytest.raises(UsageError, match="falls=-1: -1: give 0 "):
        objective(("falls=-1",), None)
    assert "speed" not in objective((), None).weights


class Bowl:
    """Costs what a gait is away from a knee of 15 degrees and a hold of 0.15 s."""

    def __init__(self, breaks_after: int = 10**6) -> None:
        self.walked: list[int] = []
        self.breaks_after = breaks_after

    def __call__(self, todo: list[tuple[int, Values]]) -> Iterator[tuple[int, Entry]]:
        for number, values in todo:
            if len(self.walked) == self.breaks_after:
                raise KeyboardInterrupt
            self.walked.append(number)
            knee, hold = values["pose.S1.knee"] - 15.0, values["hold.S1"] - 0.15
            yield number, {"cost": (knee / 4.0) ** 2 + (hold / 0.02) ** 2}


def searched(path: Path, bowl: Bowl, trials: int) -> Search:
    search = Search(GENES, SearchLog(path, {"genes": 2}), bowl, trials, seed=3)
    search.run()
    return search


def test_a_search_finds_the_bottom_of_a_bowl(tmp_path: Path) -> None:
    search = searched(tmp_path / "log", Bowl(), 60)
    assert search.values(0) == {"pose.S1.knee": 10.0, "hold.S1": 0.2}
    best = search.values(search.ranking()[0])
    assert best["pose.S1.knee"] == pytest.approx(15.0, abs=0.5)
    assert best["hold.S1"] == pytest.approx(0.15, abs=0.003)


def test_a_search_that_was_broken_off_goes_the_same_way_again(tmp_path: Path) -> None:
    whole = searched(tmp_path / "whole", Bowl(), 40).log.entries
    with pytest.raises(KeyboardInterrupt):
        searched(tmp_path / "log", Bowl(breaks_after=11), 40)
    with (tmp_path / "log").open("a") as file:
        file.write('{"trial": 11, "co')  # torn by a kill
    rest = Bowl()
    assert searched(tmp_path / "log", rest, 40).log.entries == whole
    assert rest.walked == list(range(11, len(whole)))


def test_the_file_of_another_search_is_not_gone_on_with(tmp_path: Path) -> None:
    SearchLog(tmp_path / "log", {"seed": 1, "steps": 5})
    with pytest.raises(UsageError, match="holds a search with another seed; give the same"):
        SearchLog(tmp_path / "log", {"seed": 2, "steps": 5})
    (tmp_path / "log").write_text("[1]\n")
    with pytest.raises(UsageError, match="this file is no search's"):
        SearchLog(tmp_path / "log", {"seed": 2, "steps": 5})


def test_the_command_writes_a_gait_that_walks(shell: Windup, tmp_path: Path) -> None:
    out = tmp_path / "bird.toml"
    line = ["synthesise", "robobird", "--gait", "run", "--vary", "hold.*", "target.*"]
    line += ["--population", "4", "--steps", "3", "--seeds", "1", "--out", str(out), "--json", "-"]
    first = shell(*line, "--trials", "5", "--jobs", "1")
    assert first.status == 0, first.err
    assert first.json["after"]["cost"] <= first.json["before"]["cost"]
    found = load_toml(out, GaitFile)
    assert found.balance is not None
    assert found.balance.targets["up.forward"] == first.json["values"]["target.up.forward"]
    assert shell("walk", "robobird", "--gait", out, "--steps", "3").status == 0
    kept = out.with_suffix(".trials").read_text().splitlines()
    assert [json.loads(line).get("trial") for line in kept] == [None, 0, 1, 2, 3, 4]
    again = shell(*line, "--trials", "5", "--jobs", "1")
    assert again.json == first.json


def test_bad_input_is_refused_before_anything_runs(shell: Windup, tmp_path: Path) -> None:
    out = tmp_path / "x.toml"
    for words, message in (
        (("--trials", "0"), "--trials 0: give 1 .. 1000000"),
        (("--vary", "zzz.S9.*"), "--vary zzz.S9.*: fits nothing; try 'pose.*', 'hold.*'"),
        (("--gait", "squat"), "gait 'squat' has no steps to balance"),
        (("--speed", "9"), "speed 9 m/s is outside the range of gait 'walk'"),
        (("--population", "2"), "--population 2: give 4 .. 10000"),
    ):
        ran = shell("synthesise", "op3", "--out", out, *words)
        assert (ran.status, message in ran.err) == (2, True), ran.err
    assert shell("synthesise", "op3", "--out", tmp_path / "x.csv").status == 2
    assert list(tmp_path.iterdir()) == []
