import json
from dataclasses import replace
from pathlib import Path

import pytest

from windup.tools.cli import run
from windup.tools.robot.robot import Robot


def test_the_estimate_of_a_walking_and_pushed_op3_is_within_its_limits(tmp_path: Path) -> None:
    target = tmp_path / "estimate.json"
    status = run(
        ["estimate", "op3", "--steps", "12", "--pushes", "2", "--json", str(target)],
    )
    result = json.loads(target.read_text())
    assert status == 0 and result["passed"]
    assert {(row["trial"], row["state"]) for row in result["rows"]} == {
        (trial, state)
        for trial in ("stand", "pushed", "walk", "walk pushed")
        for state in ("true", "estimated")
    }
    for row in result["rows"]:
        assert row["attitude_rms_deg"] <= 1.0
        assert row["velocity_rms_m_s"] <= 0.03


def test_an_estimate_over_its_limits_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("windup.tools.commands.estimate.VELOCITY_LIMIT", 1e-6)
    monkeypatch.setattr("windup.tools.commands.estimate.TRIALS", ("stand",))
    assert run(["estimate", "op3"]) == 1


@pytest.mark.parametrize("switches", [True, False])
@pytest.mark.parametrize(("rate", "delay"), [(None, None), (125.0, 0.016)])
def test_op3_walks_on_its_own_sensors(
    switches: bool, rate: float | None, delay: float | None
) -> None:
    from windup.hal.imu.opencr import OPENCR
    from windup.tools.assembly.build import build_estimator

    with Robot.open("op3", rate=rate, delay=delay, noise=0.2, state="estimated") as robot:
        estimator = build_estimator(robot.description, OPENCR.lag, switches=switches)
        robot.stack = replace(robot.stack, estimator=estimator)
        report = robot.walk(steps=30)
    assert report.done
    assert report.speed is not None and report.speed > 0.15


def test_an_estimate_through_a_wire_is_judged_by_the_twin_behind_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("windup.tools.commands.estimate.TRIALS", ("stand",))
    target = tmp_path / "estimate.json"
    line = "estimate duck --port twin://duck?clock=virtual --faults drop:0.01 --json"
    assert run([*line.split(), str(target)]) == 0
    rows = json.loads(target.read_text())["rows"]
    assert [row["state"] for row in rows] == ["true", "estimated"]
    assert all(0.0 < row["attitude_rms_deg"] < 1.0 for row in rows)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("--port /dev/ttyUSB0", "only a twin knows the truth; give twin://ROBOT"),
        ("--port twin://duck --delay 0.01", "leave it or --port away"),
        ("--faults drop:0.01", "needs a twin:// port"),
    ],
)
def test_an_estimate_without_a_truth_to_compare_is_refused(
    options: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["estimate", "duck", *options.split()]) == 2
    assert message in " ".join(capsys.readouterr().err.split())
