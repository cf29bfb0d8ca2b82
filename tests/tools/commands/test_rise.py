"""An op3 that lies, on the twin and through its servo bus."""

from pathlib import Path
from typing import Any

import pytest

from tests.tools.conftest import Windup
from windup.tools.behaviours.rise import rise
from windup.tools.robot.robot import Robot


@pytest.mark.parametrize("side", ["front", "back"])
def test_an_op3_gets_up_and_stands(shell: Windup, side: str) -> None:
    ran = shell("rise", "op3", "--lying", side, "--noise", "2", "--json", "-")
    assert ran.status == 0
    assert (ran.json["up"], ran.json["sides"], ran.json["reason"]) == (True, [side], "done")
    assert f"is up from its {side}" in ran.err


def test_it_does_so_over_the_wire_on_its_estimated_attitude(shell: Windup) -> None:
    ran = shell("rise", "op3", "--lying", "back", "--port", "twin://op3", "--json", "-")
    assert (ran.status, ran.json["up"]) == (0, True)


def test_an_op3_sits_down_and_gets_up_again() -> None:
    with Robot.open("op3", seed=1, noise=0.2) as robot:
        assert robot.play("sit").reason == "done"
        names = {robot.twin.model.geom(g).name for g in robot.twin.data.contact.geom.ravel()}
        assert {"l_hip", "r_hip"} <= names
        assert not {"l_hand", "r_hand", "head"} & names
        report: dict[str, Any] = {"sides": [], "peak_load": 0.0}
        rise(robot, 2, report)
        assert (report["up"], report["sides"]) == (True, ["back"])


def test_sitting_is_no_fall(shell: Windup) -> None:
    ran = shell("play", "op3", "sit", "--json", "-")
    assert (ran.status, ran.json["done"], ran.json["fell"]) == (0, True, False)


def test_one_that_stands_stands(shell: Windup) -> None:
    ran = shell("rise", "op3", "--json", "-")
    assert (ran.status, ran.json["up"], ran.json["sides"]) == (0, True, [])
    assert "stood already" in ran.err


def test_one_that_stands_is_pushed_over_as_asked(shell: Windup) -> None:
    ran = shell("rise", "op3", "--push", "4", "--push-at", "0.7", "--json", "-")
    assert (ran.status, ran.json["up"], ran.json["reason"]) == (1, False, "fell")


def test_what_does_not_get_up_ends_with_status_1_and_why(shell: Windup, my_op3: Path) -> None:
    path = my_op3 / "gaits" / "get_up_back.toml"
    text = path.read_text()
    assert "lean = [-25, 25]" in text
    path.write_text(text.replace("lean = [-25, 25]", "lean = [60, 80]"))
    ran = shell("rise", my_op3, "--lying", "back", "--tries", "1", "--json", "-")
    assert (ran.status, ran.json["up"]) == (1, False)
    assert "'crouches' was tried once and not reached: leans" in ran.json["reason"]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (
            "rise duck --lying back",
            "duck cannot get up by itself, for it has no gait get_up_back",
        ),
        ("rise op3 --tries 0", "--tries 0: give 1 .. 1000"),
    ],
)
def test_what_cannot_be_is_one_line_and_status_2(shell: Windup, line: str, message: str) -> None:
    ran = shell(*line.split())
    assert ran.status == 2
    assert message in ran.err
