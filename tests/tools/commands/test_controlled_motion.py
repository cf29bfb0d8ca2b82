"""Graphs that wait for the sensors, on the twin and through its servo bus."""

from pathlib import Path

import pytest

from tests.tools.conftest import Windup


def test_an_op3_that_is_pushed_crouches_and_stands_up_all_the_same(shell: Windup) -> None:
    line = "play op3 crouch --noise 0.2 --push 0.8 --push-at 2 --push-direction 90 --json -"
    ran = shell(*line.split())
    assert ran.status == 0
    assert (ran.json["done"], ran.json["reason"]) == (True, "done")
    assert 0.2 < ran.json["peak_load"] < 0.7
    assert ran.json["peak_joint"] in {"l_knee", "r_knee"}
    assert ran.json["high_load_s"] < 1.0


def test_the_human_balances_on_its_soft_ankles_while_it_crouches(shell: Windup) -> None:
    line = "play human crouch --noise 0.2 --push 10 --push-at 1 --push-direction 180 --json -"
    ran = shell(*line.split())
    assert ran.status == 0
    assert ran.json["peak_load"] is None, "what has no limit has no load"


@pytest.mark.parametrize("robot", ["op3", "duck"])
def test_a_robot_crouches_and_stands_up_over_its_wire(shell: Windup, robot: str) -> None:
    ran = shell("play", robot, "crouch", "--port", f"twin://{robot}?clock=virtual", "--json", "-")
    assert ran.status == 0
    assert ran.json["retries"] == 0


def test_what_is_not_reached_ends_the_command_with_status_1_and_why(
    shell: Windup, my_op3: Path
) -> None:
    path = my_op3 / "gaits" / "crouch.toml"
    strict = "joints = 0.01, still = 20, lean = [-15, 25], side = 10, feet = true, within = 0.1"
    old = "joints = 6, still = 20, lean = [-15, 25], side = 10, feet = true, within = 2.0"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, strict).replace("loop = false", "loop = false\ntries = 2"))
    ran = shell("play", my_op3, "crouch", "--json", "-")
    assert ran.status == 1
    assert (ran.json["done"], ran.json["fell"], ran.json["retries"]) == (False, False, 1)
    assert "'down' was tried 2 times and not reached: " in ran.err
    assert "degrees from its goal (0.01 is fine)" in ran.err
