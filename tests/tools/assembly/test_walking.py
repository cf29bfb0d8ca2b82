from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.tools.conftest import Windup
from windup import Robot
from windup.tools.assembly.walk_options import WalkOptions

KEYS = {
    "schema",
    "command",
    "warnings",
    "driver_clamps",
    "robot",
    "gait",
    "seed",
    "steps_requested",
    "steps",
    "fell",
    "fell_at_step",
    "reason",
    "distance_m",
    "lateral_m",
    "heading_deg",
    "speed_m_s",
    "sim_time_s",
    "wall_time_s",
    "rollouts",
    "rollout_time_s",
    "tick_ms",
    "missed",
    "regulation",
    "clamps",  # more than was asked for: each clamp that happened, and how often
    "late_plans",  # and the steps whose plan came too late, null unless paced
    "side_m_s",
    "turn_deg_s",
    "foot_clearance_mm",
    "flights",
    "flight_time_s",
    "touches",
    "skips",
    "work_j",
    "cost_of_transport",
    "shake_rad_s",
    "rollouts_a_step",
    "replans",
    "catches",
    "slipped",
    "step_model",
}


def test_the_json_of_a_walk_has_all_its_keys_and_nothing_else(shell: Windup) -> None:
    ran = shell("walk", "op3", "--steps", 10, "--seed", 3, "--noise", 0.2, "--json", "-")
    assert ran.status == 0
    result = ran.json
    assert set(result) == KEYS
    assert (result["schema"], result["command"], result["robot"]) == (1, "walk", "op3")
    assert (result["gait"], result["seed"]) == ("walk", 3)
    assert (result["steps_requested"], result["steps"]) == (10, 10)
    assert (result["fell"], result["fell_at_step"], result["reason"]) == (False, None, "done")
    assert result["speed_m_s"] is None, "the mean is over steps 11 to the end"
    assert result["missed"] is None, "nothing was paced"
    assert set(result["tick_ms"]) == {"p50", "p99"}
    assert result["rollouts"] >= 10 * 5
    assert result["distance_m"] > 0.1
    names = [row["name"] for row in result["regulation"]]
    assert "up.forward" in names
    for row in result["regulation"]:
        assert set(row) == {"name", "unit", "target", "mean", "sd"}
    assert "op3 walked 10 steps" in " ".join(ran.err.split())


def test_op3_walks_twelve_steps_and_turns_little(shell: Windup, tmp_path: Path) -> None:
    path = tmp_path / "walk.json"
    ran = shell("walk", "op3", "--steps", 12, "--json", path)
    assert (ran.status, ran.out) == (0, "")
    text = path.read_text()
    with Robot.open("op3") as robot:
        report = robot.walk(steps=12).result()
    assert (report["steps"], report["fell"]) == (12, False)
    assert abs(report["heading_deg"]) < 10.0
    assert report["distance_m"] > 0.2
    assert report["speed_m_s"] == pytest.approx(0.2, abs=0.1)
    assert f'"distance_m": {round(report["distance_m"], 6)}' in text, "the same walk"


def test_the_same_seed_walks_the_same_way_to_the_bit() -> None:
    def walk(seed: int) -> bytes:
        with Robot.open("op3", noise=0.2, seed=seed) as robot:
            report = robot.walk(steps=5)
            return np.concatenate([report.path.ravel(), robot.twin.save().physics]).tobytes()

    assert walk(1) == walk(1)
    assert walk(1) != walk(2)


@pytest.mark.parametrize("seed", range(4))
def test_the_human_falls_in_four_to_eight_steps_without_balance(seed: int) -> None:
    with Robot.open("human", noise=0.2, seed=seed) as robot:
        options = WalkOptions(open_loop=True, rv=("up",), torso_servo=False)
        report = robot.walk(steps=30, options=options).result()
    assert report["fell"]
    assert 4 <= report["steps"] <= 8
    assert (report["reason"], report["rollouts"]) == ("fell", 0)


def test_the_human_walks_as_in_the_thesis(shell: Windup) -> None:
    line = "walk human --rv up --no-torso-servo --sampling fl --target .25 --steps 15 --json -"
    ran = shell(*line.split())
    assert ran.status == 0
    result = ran.json
    assert (result["steps"], result["fell"]) == (15, False)
    forward = result["regulation"][0]
    assert (forward["name"], forward["target"]) == ("up.forward", 0.25)
    assert forward["mean"] == pytest.approx(0.25, abs=0.1)
    assert result["distance_m"] > 3.0


def test_a_fall_is_status_1_and_says_in_which_step(shell: Windup) -> None:
    ran = shell("walk", "human", "--open-loop", "--no-torso-servo", "--steps", 30, "--json", "-")
    assert ran.status == 1
    assert ran.json["fell"] is True
    assert f"human fell in step {ran.json['fell_at_step']} of 30" in " ".join(ran.err.split())


def test_several_seeds_are_a_row_each_and_a_summary(shell: Windup) -> None:
    ran = shell("walk", "op3", "--steps", 1, "--seeds", 2, "--open-loop", "--json", "-")
    assert ran.status == 0
    result = ran.json
    rest = {"warnings", "driver_clamps", "robot", "rows", "summary"}
    assert set(result) == {"schema", "command", *rest}
    assert [row["seed"] for row in result["rows"]] == [0, 1]
    assert all(set(row) == KEYS - {"schema", "command"} for row in result["rows"])
    assert (result["summary"]["runs"], result["summary"]["walked"]) == (2, 2)


def test_a_users_own_folder_walks_by_its_path(shell: Windup, my_op3: Path) -> None:
    toml = my_op3 / "robot.toml"
    toml.write_text(toml.read_text().replace('name = "op3"', 'name = "mine"', 1))
    ran = shell("walk", my_op3, "--steps", 2, "--json", "-")
    assert ran.status == 0
    assert ran.json["robot"] == "mine"


def test_a_bare_target_is_the_first_forward_variables(shell: Windup) -> None:
    line = "walk human --rv up --target .2 up.lateral=.01 --open-loop --steps 2 --json -"
    rows = shell(*line.split()).json["regulation"]
    assert [(row["name"], row["target"]) for row in rows] == [
        ("up.forward", 0.2),
        ("up.lateral", 0.01),
    ]


def test_a_report_tells_of_the_walk_and_not_of_where_the_limp_robot_fell() -> None:
    with Robot.open("op3", port="twin://op3?clock=virtual") as robot:
        report = robot.walk(steps=4)
        before = report.result()
    after = report.result()
    assert robot.twin.base.position[:2] != pytest.approx(report.path[-1, :2], abs=0.02)
    for key in ("distance_m", "lateral_m", "cost_of_transport"):
        assert after[key] == before[key]


def test_another_rate_and_delay_are_those_of_the_run() -> None:
    with Robot.open("op3", rate=125.0, delay=0.016) as robot:
        assert robot.period == pytest.approx(0.008)
        assert robot.twin.delay == 0.016
        report = robot.walk(steps=2, options=WalkOptions(open_loop=True))
    ticks = report.result()["sim_time_s"] / 0.008
    assert ticks == pytest.approx(robot.loop.ticks, abs=1.0)


def test_the_picture_of_a_walk_is_drawn(shell: Windup, tmp_path: Path) -> None:
    picture = tmp_path / "walk.png"
    ran = shell("walk", "op3", "--steps", 2, "--open-loop", "--plot", picture)
    assert ran.status == 0
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_robots_are_listed_with_their_gaits(shell: Windup) -> None:
    ran = shell("robots", "--json", "-")
    assert ran.status == 0
    listed = {row["robot"]: row for row in ran.json["robots"]}
    assert {"op3", "human"} <= set(listed)
    assert (listed["op3"]["joints"], listed["op3"]["drive"]) == (20, "servo")
    assert (listed["human"]["joints"], listed["human"]["rate_hz"]) == (19, 125.0)
    assert "walk" in listed["human"]["gaits"]
    assert "op3" in ran.err


def test_a_graph_is_played_to_its_end(shell: Windup) -> None:
    ran = shell("play", "op3", "wave", "--json", "-")
    assert ran.status == 0
    result = ran.json
    assert (result["robot"], result["graph"], result["reason"]) == ("op3", "wave", "done")
    assert result["fell"] is False
    assert 1.0 < result["sim_time_s"] < 20.0


def test_a_graph_is_played_for_some_seconds(shell: Windup) -> None:
    ran = shell("play", "op3", "squat", "--seconds", 0.5, "--json", "-")
    assert ran.status == 0
    assert ran.json["sim_time_s"] == pytest.approx(0.5, abs=0.01)


def test_a_graph_without_an_end_is_played_for_five_seconds() -> None:
    with Robot.open("op3") as robot:

        def watch(observation: object) -> None:
            assert robot.twin.time < 6.0, "it plays for ever"

        robot.watch.append(watch)
        report = robot.play("squat")
        assert report.sim_time == pytest.approx(5.0, abs=0.02)
        assert not robot.fallen


def test_several_look_on_and_one_may_take_itself_off() -> None:
    seen: list[str] = []
    steps: list[tuple[int, int]] = []
    with Robot.open("op3") as robot:

        def once(observation: object) -> None:
            seen.append("once")
            robot.watch.remove(once)

        robot.watch += [once, lambda _: seen.append("always")]

        def noting(who: int) -> Callable[[int, float], None]:
            return lambda number, speed: steps.append((who, number))

        open_loop = WalkOptions(open_loop=True)
        robot.walk(steps=2, options=open_loop, on_step=[noting(1), noting(2)])
    assert seen[:3] == ["once", "always", "always"] and "once" not in seen[1:]
    assert steps == [(1, 1), (2, 1), (1, 2), (2, 2)]
