import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from windup.tools.behaviours.push_edge import Search, find_edge
from windup.tools.behaviours.push_trial import PushPlan
from windup.tools.cli import run
from windup.tools.commands.envelope_tables import summarise
from windup.tools.commands.push import Push


def pushed(capsys: pytest.CaptureFixture[str], *more: str) -> tuple[int, str]:
    status = run(["push", "op3", *more])
    return status, " ".join(capsys.readouterr().err.split())


def test_a_light_push_is_stood_without_a_step(tmp_path: Path) -> None:
    out = tmp_path / "push.json"
    assert run(["push", "op3", "--impulse", "0.7", "--json", str(out)]) == 0
    row = json.loads(out.read_text())
    assert row["survived"]
    assert row["steps"] == 0
    assert row["settling_s"] < 2.0
    assert row["astray_m"] < 0.015


def test_steps_survive_what_a_stiff_pose_does_not(tmp_path: Path) -> None:
    out = tmp_path / "push.json"
    line = ["push", "op3", "--impulse", "1.8", "--state", "estimated", "--json", str(out)]
    assert run([*line, "--way", "hold"]) == 1
    assert not json.loads(out.read_text())["survived"]
    assert run(line) == 0
    assert json.loads(out.read_text())["steps"] > 0


def test_random_directions_are_those_of_the_seed() -> None:
    push = Push(robot="op3", impulse=1.0, direction="random", times=3)
    first, again, other = (push.plan(seed).directions for seed in (3, 3, 4))
    assert first == again != other
    assert len(set(first)) == 3


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ([], "--envelope"),
        (["--impulse", "-1"], "--impulse -1: give 0 .. 10000 N s"),
        (["--impulse", "1", "--body", "tail"], "unknown body 'tail'"),
        (["--impulse", "1", "--height", "3"], "above the floor"),
        (["--impulse", "1", "--way", "magic"], "predictive"),
        (["--impulse", "1", "--stance", "lotus"], "lotus"),
        (["--impulse", "1", "--duration", "0"], "more than 0, up to 10000000 s"),
        (["--impulse", "1", "--gains", "0"], "--gains 0: give more than 0"),
        (["--impulse", "1", "--speed", "0.1"], "--during walk"),
        (["--impulse", "1", "--during", "walk", "--stance", "ready"], "for a robot that stands"),
        (["--impulse", "1", "--during", "walk", "--way", "hold"], "a step rule"),
        (["--impulse", "1", "--during", "walk", "--speed", "9"], "0 .. 0.36 m/s"),
    ],
)
def test_what_cannot_be_is_said_in_one_line(
    capsys: pytest.CaptureFixture[str], more: list[str], said: str
) -> None:
    status, words = pushed(capsys, *more)
    assert status == 2
    assert said in words


def test_a_robot_that_cannot_step_is_told_who_can(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["push", "human12", "--impulse", "1"]) == 2
    assert "op3" in capsys.readouterr().err


def search(way: str, survives: Callable[[float], bool]) -> Search:
    """Return a search in which a robot survives so, and takes a step from 0.5 N s on."""

    def push(seed: int, plan: PushPlan) -> dict[str, Any]:
        steps = 0 if plan.way == "feet" else int(plan.impulse > 0.5)
        how = {"impulse": plan.impulse, "steps": steps, "settling_s": 1.0, "astray_m": 0.01}
        return how | {"survived": survives(plan.impulse)}

    return Search(push, 0, Push(robot="op3").plan(0), way, 0.0, 1.0)


def test_the_edge_is_the_last_before_the_first_fall() -> None:
    edge = find_edge(search("hold", lambda impulse: impulse < 0.93))
    assert edge.impulse == pytest.approx(0.9)
    assert [row["survived"] for row in edge.grid] == [True, True, False, False, False, False]


def test_a_fall_in_the_middle_of_the_grid_bounds_the_edge() -> None:
    edge = find_edge(search("hold", lambda impulse: impulse != 0.8))
    assert edge.impulse == pytest.approx(0.75)
    assert [row["survived"] for row in edge.grid].count(True) == 5


def test_a_step_is_needless_where_the_feet_alone_do_as_well() -> None:
    found = {way: find_edge(search(way, lambda impulse: impulse < 0.93)) for way in ("feet", "ip")}
    ways = {way: {0.0: edge} for way, edge in found.items()}
    assert summarise(ways["feet"], ways)["needless"] == 0
    summary = summarise(ways["ip"], ways)
    assert (summary["needless"], summary["survived"], summary["grid"]) == (1, 2, 6)


def test_the_envelope_is_a_table_a_picture_and_json(tmp_path: Path) -> None:
    out, picture = tmp_path / "envelope.json", tmp_path / "envelope.png"
    ways = ["--ways", "hold", "--directions", "1", "--stance", "stand", "--jobs", "1"]
    assert (
        run(["push", "op3", "--envelope", *ways, "--json", str(out), "--plot", str(picture)]) == 0
    )
    hold = json.loads(out.read_text())["ways"]["hold"]
    assert 0.6 < hold["worst"] < 1.4
    assert [row["survived"] for row in hold["trials"]].count(False) >= 1
    assert picture.stat().st_size > 1000


def test_a_walk_is_caught_by_steps_halts_and_goes_on(tmp_path: Path) -> None:
    out = tmp_path / "push.json"
    line = ["push", "op3", "--during", "walk", "--impulse", "1.4", "--direction", "180"]
    assert run([*line, "--at", "4.1", "--json", str(out)]) == 0
    row = json.loads(out.read_text())
    (catch,) = row["catches"]
    assert row["pushed_at"][0] < catch["handed_over_at"] < row["pushed_at"][0] + 0.15
    assert catch["handed_over_at"] < catch["stood_at"] < catch["handed_back_at"]
    assert catch["walked_after"] >= 20


def test_a_walk_that_bears_a_push_is_left_alone(tmp_path: Path) -> None:
    out = tmp_path / "push.json"
    line = ["push", "op3", "--during", "walk", "--impulse", "0.6", "--direction", "60"]
    assert run([*line, "--json", str(out)]) == 0
    assert json.loads(out.read_text())["catches"] == []
