"""`windup stride` on the twin."""

import json
from pathlib import Path

import pytest

from windup.hal.errors import UsageError
from windup.tools.behaviours.striding import Leg, read_leg
from windup.tools.cli import run


def test_it_walks_changes_direction_turns_and_halts_with_its_sensors(tmp_path: Path) -> None:
    out = tmp_path / "stride.json"
    line = ["stride", "op3", "--state", "estimated", "--speed", "0.1", "--json", str(out)]
    assert run([*line, "--then", "3.5,0.1,90,20", "--seconds", "7"]) == 0
    row = json.loads(out.read_text())
    assert row["good"]
    assert row["steps"] > 12
    first, second = row["legs"]
    assert first["measured_speed"] == pytest.approx(0.1, rel=0.3)
    assert first["measured_heading"] == pytest.approx(0.0, abs=25.0)
    assert second["measured_heading"] == pytest.approx(90.0, abs=25.0)
    assert row["turned_deg"] == pytest.approx(20.0, abs=8.0)


def test_what_a_later_order_leaves_out_stays_as_it_was() -> None:
    before = Leg(0.0, 0.1, 30.0, 10.0)
    assert read_leg("4,0", before) == Leg(4.0, 0.0, 30.0, 10.0)
    assert read_leg("4,0.2,-90", before) == Leg(4.0, 0.2, -90.0, 10.0)
    with pytest.raises(UsageError, match="after 4 s"):
        read_leg("4,0.1", Leg(4.0, 0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--speed", "0.9"], "give 0 .. 0.2"),
        (["--speed", "nan"], "--speed nan: give a finite number of m/s"),
        (["--heading", "inf"], "degrees"),
        (["--seconds", "0"], "more than 0"),
        (["--then", "5"], "SECONDS,SPEED"),
        (["--then", "a,b"], "'a' is no number"),
        (["--then", "9,0.1"], "more than 9"),
        (["--slope", "99"], "-30 .. 30"),
    ],
)
def test_what_cannot_be_is_said_in_one_line(
    more: list[str], said: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(["stride", "op3", *more]) == 2
    words = capfd.readouterr().err.strip().splitlines()
    assert len(words) == 1
    assert said in words[0]


def test_a_robot_that_cannot_stride_is_told_who_can(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["stride", "duck"]) == 2
    assert "op3" in capsys.readouterr().err
