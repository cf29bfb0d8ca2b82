"""Pushes of a robot that must keep off some ground."""

import json
from dataclasses import replace
from pathlib import Path

import mujoco
import pytest

from windup.tools.assembly.forbid import forbidden
from windup.tools.assembly.stepping import footing_of, stepping_stance
from windup.tools.behaviours.landings import Landings, format_landings
from windup.tools.cli import run
from windup.tools.robot.robot import Robot

LINE = ["push", "op3", "--impulse", "1.8"]


def test_the_other_foot_steps_where_one_must_not(tmp_path: Path) -> None:
    out = tmp_path / "push.json"
    for side, foot in ((+1, "right_foot"), (-1, "left_foot")):
        zone = f"--forbid=0.13,{side * 0.07},0.06,0.08"
        assert run([*LINE, zone, "--json", str(out)]) == 0
        row = json.loads(out.read_text())
        assert row["survived"]
        assert row["landings"][0]["foot"] == foot
        assert row["landings"][0]["x"] > 0.03
        assert (row["landed_forbidden"], row["on_forbidden"]) == (0, [])


def test_a_foot_that_comes_down_on_forbidden_ground_is_seen() -> None:
    with Robot.open("op3") as robot:
        stance = stepping_stance(robot.description)
        robot.start_in(stance)
        twin = robot.twin
        watch = Landings(
            robot, footing_of(robot.description, stance), forbidden(["0.125,0.07,0.04"])
        )
        seen = robot.backend.read()
        for time, way in ((0.0, 0.0), (0.1, 0.01), (0.2, 0.05)):
            twin.data.qpos[0] += way
            mujoco.mj_forward(twin.model, twin.data)
            watch.update(replace(seen, time=time))
    assert [fall["foot"] for fall in watch.falls] == ["left_foot", "right_foot"] * 2
    assert [fall["forbidden"] for fall in watch.falls] == [False, False, True, False]
    record = watch.record()
    assert (record["landed_forbidden"], record["on_forbidden"]) == (1, ["left_foot"])
    assert format_landings(record).endswith("forbidden ground was touched by left_foot")


@pytest.mark.parametrize(
    ("text", "area"),
    [("0.2,0,0.1", 0.0314), ("0.2,0,0.1,0.3", 0.03), ("0,0,1,0,0,1", 0.5), ("-1,0,0.1,0.1", 0.01)],
)
def test_circles_rectangles_and_polygons(text: str, area: float) -> None:
    (region,) = forbidden([text])
    assert region.area == pytest.approx(area, rel=0.01)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("0.1,0.2", "circle"),
        ("a,b,c", "'a' is no number"),
        ("nan,0,1", "give a finite number of m"),
        ("0,0,0", "no area"),
        ("1,1,0,1", "above 0"),
        ("0,0,1,0,1,1,0", "as many X as Y"),
        ("0,0,1,1,1,0,0,1", "crosses itself"),
        ("0,0,0.5,0.5", "stands on forbidden ground"),
    ],
)
def test_what_cannot_be_forbidden_is_said_in_one_line(
    text: str, said: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run([*LINE, f"--forbid={text}"]) == 2
    words = capfd.readouterr().err.strip().splitlines()
    assert len(words) == 1
    assert said in words[0]
