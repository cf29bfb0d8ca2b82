"""Falls that cannot be prevented, and what must not be taken for one."""

from pathlib import Path
from typing import Any

import pytest

from tests.tools.conftest import Windup
from windup.tools.robot.robot import Robot

PUSHED = ("--seconds", 2.4, "--push", 4, "--push-at", 0.6, "--json", "-")
WIRE = ("--port", "twin://op3?clock=virtual")


def trunk(result: dict[str, Any]) -> float:
    return float(max(result["torso_impact_m_s"], result["head_impact_m_s"]))


@pytest.mark.parametrize("direction", [0, 112.5, 180])
def test_an_op3_that_must_fall_falls_softer(shell: Windup, direction: float) -> None:
    line = ["stand", "op3", "--push-direction", direction, *PUSHED]
    stiff, soft = shell(*line, "--no-protect"), shell(*line)
    assert (stiff.status, soft.status) == (1, 1)
    assert soft.json["reason"] == "fell"
    assert trunk(soft.json) < 0.7 * trunk(stiff.json)
    assert soft.json["peak_load"] <= 1.0
    assert "torso hits the floor at" in soft.err


def test_so_it_does_on_estimated_state_through_its_bus(shell: Windup) -> None:
    later = ("--seconds", 2.4, "--push", 4, "--push-at", 2.2, "--json", "-")  # it stands by then
    line = ["stand", "op3", *WIRE, "--push-direction", "-90", *later]
    stiff, soft = shell(*line, "--no-protect"), shell(*line)
    assert trunk(soft.json) < 0.7 * trunk(stiff.json)
    assert soft.json["peak_load"] <= 1.0


def test_a_push_that_it_survives_is_no_alarm(shell: Windup) -> None:
    line = "stand op3 --seconds 2.5 --push 1.4 --push-at 0.6 --push-direction 90 --json -"
    soft, stiff = shell(*line.split()), shell(*line.split(), "--no-protect")
    assert (soft.status, soft.json["reason"]) == (0, "done")
    assert soft.json["largest_error_deg"] == stiff.json["largest_error_deg"]


def test_a_run_goes_on_until_the_robot_lies_still() -> None:
    with Robot.open("op3") as robot:
        robot.push(4.0, delay=0.6)
        assert robot.stand(0.7).reason == "fell"
        assert robot.loop.sim_time > 1.2
        assert robot.base is not None
        assert abs(robot.base.angular_velocity).max() < 0.5


def test_a_way_to_fall_needs_a_pose_and_a_reach(shell: Windup, my_op3: Path) -> None:
    file = my_op3 / "robot.toml"
    text = file.read_text()
    file.write_text(text.replace('pose = "fall_back"', 'pose = "fall_bakc"'))
    assert "unknown pose 'fall_bakc'; did you mean 'fall_back'?" in shell("stand", my_op3).err
    file.write_text("\n".join(line for line in text.splitlines() if not line.startswith("reach")))
    assert "fall.way: needs fall.reach" in shell("stand", my_op3).err


def test_windup_push_says_how_hard_it_fell(shell: Windup) -> None:
    line = [
        "push",
        "op3",
        "--impulse",
        "4",
        "--way",
        "hold",
        "--stance",
        "stand",
        "--at",
        "0.3",
        "--json",
        "-",
    ]
    soft, stiff = shell(*line), shell(*line, "--no-protect")
    assert (soft.status, stiff.status) == (1, 1)
    assert (soft.json["survived"], soft.json["reason"]) == (False, "fell")
    assert trunk(soft.json) < 0.7 * trunk(stiff.json)
    assert soft.json["torso_knock_m_s"] < stiff.json["torso_knock_m_s"]
    assert soft.json["overload_s"] == 0.0
    assert "torso hits the floor at" in soft.err
