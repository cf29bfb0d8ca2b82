import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.tools.conftest import Windup
from windup.hal.observation import Observation
from windup.hal.stopping.stop_flag import Outcome, StopFlag
from windup.robots import RobotDescription
from windup.tools.robot.robot import Robot
from windup.tools.stopping.interrupts import RunInterruptedError, forget_interruption
from windup.tools.stopping.stop_runs import robot_name, stop_runs


@pytest.fixture(autouse=True)
def own_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Let this test see no runs but its own."""
    folder = tmp_path / "flags"
    folder.mkdir(mode=0o700)
    monkeypatch.setattr("windup.hal.stopping.stop_flag.private_folder", lambda: folder)
    monkeypatch.setattr("windup.tools.stopping.stop_runs.folders_to_search", lambda: [folder])
    return folder


def test_a_run_in_real_time_stops_at_the_next_tick_and_says_what_it_read() -> None:
    with Robot.open("op3", realtime=True) as robot:
        flag = robot.session.flag
        assert flag is not None

        def stop_after_three_ticks(observation: Observation) -> None:
            if robot.loop.ticks == 3:
                flag.request()

        robot.watch.append(stop_after_three_ticks)
        with pytest.raises(RunInterruptedError, match="stopped by `windup stop`"):
            robot.stand(60.0)
        assert flag.outcome == Outcome(said="torque is off at all 20 joints, read back")
        assert robot.loop.ticks == 3
    assert not flag.path.exists()


def test_a_request_before_torque_comes_on_keeps_it_off() -> None:
    with Robot.open("op3", realtime=True) as robot:
        assert robot.session.flag is not None
        robot.session.flag.request()
        with pytest.raises(RunInterruptedError):
            robot.stand(60.0)
        assert robot.loop.ticks == 0
    forget_interruption()


def test_a_mere_simulation_has_no_flag(own_folder: Path) -> None:
    with Robot.open("op3") as robot:
        assert robot.session.flag is None
    assert list(own_folder.iterdir()) == []


def test_nothing_to_stop_is_told_with_the_other_way(shell: Windup) -> None:
    ran = shell("stop", "op3")
    assert (ran.status, ran.out) == (2, "")
    assert ran.err.startswith("windup: nothing of yours runs op3")
    assert ran.err.endswith("`windup stop op3 --port URL` switches its servos off all the same\n")


def test_nothing_to_stop_is_no_failure_for_all(shell: Windup) -> None:
    ran = shell("stop", "--all", "--json", "-")
    assert (ran.status, ran.json["rows"], ran.err) == (0, [], "nothing of yours runs\n")


def test_a_run_that_hangs_without_torque_is_not_waited_for(shell: Windup) -> None:
    flag = StopFlag.create("op3")
    ran = shell("stop", "op3", "--json", "-")
    assert (ran.status, ran.json["stopped"], ran.json["robot"]) == (0, True, "op3")
    assert "does not answer; none of its servos has torque" in ran.err
    flag.remove()


def died(guardian: int) -> StopFlag:
    """Return the flag of a run that has died."""
    flag = StopFlag.create("op3")
    flag.guardian = guardian
    with subprocess.Popen(["sleep", "0"]) as dead:
        dead.wait()
        flag._words[1] = dead.pid
    return flag


def test_who_comes_late_is_told_what_the_guardian_has_read(shell: Windup) -> None:
    flag = died(guardian=2**22 + 1)
    flag.finish(Outcome(said="torque is off at all servos, read back", by="guardian"))
    ran = shell("stop", "op3", "--json", "-")
    assert (ran.status, ran.json["by"], ran.json["stopped"]) == (0, "guardian", True)
    flag.remove()


def test_where_nobody_is_left_torque_may_be_on(shell: Windup) -> None:
    flag = died(guardian=2**22 + 1)
    ran = shell("stop", "op3", "--json", "-")
    assert (ran.status, ran.json["stopped"]) == (3, False)
    assert "its program and its guardian have died, so torque may be on" in ran.err
    flag.remove()


def test_another_robot_is_left_alone() -> None:
    flag = StopFlag.create("duck")
    assert stop_runs("op3") == [] and not flag.asked()
    flag.remove()


def test_a_robot_can_be_given_by_its_folder(op3: RobotDescription) -> None:
    assert robot_name(str(op3.folder)) == "op3"
    assert robot_name("duck") == "duck"


@pytest.mark.parametrize("words", [["stop"], ["stop", "op3", "--all"]])
def test_a_stop_of_nothing_and_of_too_much_is_refused(shell: Windup, words: list[str]) -> None:
    ran = shell(*words)
    assert (ran.status, ran.err) == (2, "windup: give either the ROBOT to stop, or --all\n")


def test_the_command_loads_none_of_the_heavy_packages(tmp_path: Path) -> None:
    program = """
import sys, json
from pathlib import Path
from windup.tools.stopping import stop_runs
stop_runs.folders_to_search = lambda: []
from windup.tools.cli import run
status = run(["stop", "--all"])
heavy = {"numpy", "mujoco", "tyro", "rich", "scipy", "serial"} & set(sys.modules)
print(json.dumps([status, sorted(heavy)]))
"""
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert json.loads(ran.stdout) == [0, []], ran.stderr
