"""An op3 that puts its feet where it is told."""

from pathlib import Path

import numpy as np
import pytest

from tests.tools.conftest import Windup
from windup.control.footprints.footprints import Footprint, read_footprints
from windup.hal.errors import UsageError
from windup.robots import RobotDescription
from windup.tools.behaviours.directed import build_checks, feet_of


@pytest.mark.parametrize("more", [(), ("--state", "estimated"), ("--port", "twin://op3")])
def test_a_foot_comes_down_where_it_is_told(shell: Windup, more: tuple[str, ...]) -> None:
    where = ("--to", "0.05", "0.12", "--yaw", "10")
    ran = shell("step", "op3", "--foot", "left", *where, *more, "--json", "-")
    (fall,) = ran.json["falls"]
    assert (ran.status, ran.json["good"], ran.json["reason"]) == (0, True, "done")
    assert fall["foot"] == "left_foot"
    assert np.hypot(fall["place"]["x"] - 0.05, fall["place"]["y"] - 0.12) < 0.01
    assert fall["place"]["yaw_deg"] == pytest.approx(10.0, abs=5.0)


def test_steps_of_a_file_are_walked_in_the_frame_of_the_start(
    shell: Windup, tmp_path: Path
) -> None:
    path = tmp_path / "two.toml"
    rows = [("right", 0.04, -0.06), ("left", 0.04, 0.06)]
    steps = "".join(f'[[step]]\nfoot = "{foot}"\nx = {x}\ny = {y}\n' for foot, x, y in rows)
    path.write_text('frame = "start"\n' + steps)
    ran = shell("footprints", "op3", path, "--json", "-")
    assert (ran.status, ran.json["stepped"]) == (0, 2)
    assert all(fall["away_m"] < 0.01 for fall in ran.json["falls"])
    assert "took 2 of 2 steps" in ran.err


def test_random_footprints_are_written_as_a_file_that_can_be_walked(
    shell: Windup, tmp_path: Path
) -> None:
    first = shell("footprints", "op3", "--random", "20", "--seed", "3", "--write")
    path = tmp_path / "random.toml"
    path.write_text(first.out)
    again = shell("footprints", "op3", path, "--write")
    assert (first.status, again.status) == (0, 0)
    assert first.out == again.out
    assert first.out.count("[[step]]") == 20
    other = shell("footprints", "op3", "--random", "20", "--seed", "4", "--write")
    assert other.out != first.out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("left", "--to", "0.05", "0.05"), "crosses right_foot or steps on it; (0.050, 0.08"),
        (("left", "--to", "0", "-0.12"), "crosses right_foot"),
        (("right", "--to", "0.3", "-0.12"), "right_foot does not reach (0.300, -0.120) m"),
        (("tail", "--to", "0", "0.12"), "unknown foot 'tail'; known: left, right"),
        (("left", "--to", "nan", "0.12"), "--to nan: give a finite number of m"),
        (
            ("left", "--to", "0", "0.12", "--duration", "-1"),
            "--duration -1: give more than 0, up to 10000000 s",
        ),
    ],
)
def test_a_step_that_cannot_be_is_refused_in_one_line(
    shell: Windup, arguments: tuple[str, ...], said: str
) -> None:
    ran = shell("step", "op3", "--foot", *arguments)
    assert ran.status == 2
    assert said in ran.err
    assert len(ran.err.strip().splitlines()) == 1


def test_a_robot_without_the_file_is_told_who_has_it(shell: Windup) -> None:
    ran = shell("step", "duck", "--foot", "left", "--to", "0", "0.1")
    assert (ran.status, "robots that have: human, human_handstand, op3" in ran.err) == (2, True)


def test_footprints_need_a_file_or_a_number(shell: Windup) -> None:
    for arguments in ((), ("--random", "-1"), ("prints.toml", "--random", "3")):
        assert shell("footprints", "op3", *arguments).status == 2


def test_a_crossing_later_in_a_file_is_found_before_anything_moves(op3: RobotDescription) -> None:
    prints = [
        Footprint(0, np.array([0.05, 0.12, 0.0]), "start"),
        Footprint(1, np.array([0.05, 0.08, 0.0]), "start"),
    ]
    with pytest.raises(UsageError, match=r"step 2: right_foot .* crosses left_foot"):
        build_checks(op3).check(prints)


def test_what_is_said_to_be_in_reach_is(op3: RobotDescription) -> None:
    checks = build_checks(op3)
    with pytest.raises(UsageError) as caught:
        checks.check([Footprint(0, np.array([0.3, 0.12, 0.0]))])
    x, y = (float(part) for part in str(caught.value).split("(")[2].split(")")[0].split(","))
    checks.check([Footprint(0, np.array([x - 1e-3, y, 0.0]))])
    assert x > 0.05


def test_the_example_turns_round_within_reach(op3: RobotDescription) -> None:
    path = Path(__file__).parents[3] / "docs" / "turn_left.toml"
    prints = read_footprints(path, feet_of(op3))
    build_checks(op3).check(prints)
    assert sum(np.degrees(one.place[2]) for one in prints) == pytest.approx(90.0)
