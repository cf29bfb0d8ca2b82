from pathlib import Path

import pytest

from tests.tools.conftest import Windup
from windup.control.limit_cycle.balancer import Balancer
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.robot.robot import Robot

PORT = "--port twin://op3"
WARM = "heat:at=1:ids=14:degrees=68"
HOT = "heat:at=1:ids=14:degrees=75"


def last_line(err: str) -> str:
    return err.strip().splitlines()[-1]


@pytest.fixture(autouse=True)
def rings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))


@pytest.mark.parametrize("command", ["stand op3 --seconds 4", "play op3 wave --seconds 4"])
def test_a_warning_is_in_the_last_line_in_json_and_in_health(shell: Windup, command: str) -> None:
    ran = shell(*f"{command} {PORT} --faults {WARM} --json -".split())
    assert ran.status == 0, "a warning is no failure"
    assert last_line(ran.err) == "warning: l_knee was at 68 degrees C (warning at 65)"
    (warning,) = ran.json["warnings"]
    assert warning | {"since": None} == {
        "kind": "temperature",
        "joints": ["l_knee"],
        "value": 68.0,
        "limit": 65.0,
        "count": 1,
        "since": None,
    }


def test_health_says_what_the_run_said(shell: Windup) -> None:
    shell(*f"stand op3 --seconds 6 {PORT} --faults {HOT}".split())
    seen = shell(*f"health op3 {PORT} --faults {HOT} --json -".split())
    assert seen.status == 1
    (warning,) = seen.json["warnings"]
    assert (warning["kind"], warning["joints"]) == ("temperature", ["l_knee"])
    assert seen.json["complaints"][0]["what"] == "at 75 degrees C (stop at 72)"


def test_a_stop_is_the_last_line_and_the_warning_of_its_cause_is_not_said_again(
    shell: Windup,
) -> None:
    ran = shell(*f"stand op3 --seconds 6 {PORT} --faults {HOT} --json -".split())
    assert ran.status == 3
    (line,) = ran.err.strip().splitlines()
    assert line.startswith("windup: l_knee is at 75 degrees C (stop at 72): let it cool")
    assert ran.json["error"]["kind"] == "Unhealthy"
    assert [row["kind"] for row in ran.json["warnings"]] == ["temperature"]


def test_another_warning_is_said_before_the_stop(shell: Windup) -> None:
    faults = f"imu_silent:at=1,{HOT}"
    ran = shell(*f"stand op3 --seconds 6 {PORT} --faults {faults}".split())
    first, second = ran.err.strip().splitlines()
    assert first.startswith("warning: the IMU was silent for ")
    assert second.startswith("windup: l_knee is at 75")


def test_a_run_without_warnings_says_so_to_programs_only(shell: Windup) -> None:
    ran = shell("stand", "op3", "--seconds", 1, "--json", "-")
    assert ran.json["warnings"] == []
    assert "warning" not in ran.err


def test_a_command_that_runs_no_robot_has_none(shell: Windup) -> None:
    assert "warnings" not in shell("scan", "twin://op3", "--json", "-").json


def test_seeds_in_processes_of_their_own_have_their_warnings(shell: Windup) -> None:
    ran = shell("walk", "op3", "--steps", 1, "--seeds", 2, "--json", "-")
    assert [row["warnings"] for row in ran.json["rows"]] == [[], []]
    assert ran.json["warnings"] == []


def test_late_plans_of_a_walk_are_in_its_last_line(
    shell: Windup, monkeypatch: pytest.MonkeyPatch
) -> None:
    begin = Balancer._begin_step

    def late(self: Balancer, *arguments: object) -> None:
        begin(self, *arguments)  # type: ignore[arg-type]
        self.late += 1

    monkeypatch.setattr(Balancer, "_begin_step", late)
    ran = shell("walk", "op3", "--steps", 3, "--json", "-")
    assert last_line(ran.err) == (
        "warning: 4 of 4 plans came late: this computer is too slow for 250 Hz: "
        "try `--model library` or a lower --rate"
    )
    assert ran.json["warnings"][0]["kind"] == "late plans"


def test_late_plans_are_counted_though_the_walk_fails() -> None:
    with Robot.open("op3") as robot:

        def watch(_: object) -> None:
            if robot.twin.time > 0.5:
                raise ZeroDivisionError("somebody's own watch")

        robot.watch.append(watch)
        with pytest.raises(Exception, match="somebody's own watch"):
            robot.walk(steps=5, options=WalkOptions())
        assert robot.slowness.plans >= 1 and robot.slowness.ticks > 100


def test_a_bus_that_is_too_slow_for_its_rate_is_said(shell: Windup) -> None:
    ran = shell("stand", "duck", "--port", "twin://duck", "--rate", 500, "--seconds", 1)
    assert ran.status == 0
    assert last_line(ran.err).endswith(
        "of the ticks came late: the bus is too slow for 500 Hz: try a lower --rate"
    )
