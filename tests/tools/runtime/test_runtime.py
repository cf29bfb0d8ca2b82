"""A twin that is up, in real time, from outside: as terminals and programs see it."""

import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.tools.runtime.runtime_process import command, windup_up
from windup.hal.errors import UsageError
from windup.tools.remote.client import RuntimeClient
from windup.tools.remote.messages import Goal, Status
from windup.tools.remote.remote_robot import RemoteRobot


@pytest.fixture(scope="module")
def base() -> Iterator[Path]:
    """A folder with a twin of OP3 that is up."""
    with tempfile.TemporaryDirectory() as folder, windup_up(Path(folder), "op3"):
        yield Path(folder)


@pytest.fixture
def robot(base: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[RemoteRobot]:
    monkeypatch.setattr("windup.hal.stopping.folder.BASE", base)
    with RemoteRobot("op3") as robot:
        yield robot


def until(robot: RemoteRobot, true: Callable[[Status], bool]) -> Status:
    """Ask how it is until something is true."""
    while not true(status := robot.status):
        pass
    return status


def test_it_holds_between_two_behaviours_and_never_goes_limp(robot: RemoteRobot) -> None:
    states: list[str] = []
    robot._client.on_status = lambda status: states.append(status.state)
    assert robot.stand(0.5).good
    report = robot.walk(speed=0.1, steps=4)
    assert report.good and report.result["steps"] >= 4, str(report)
    assert robot.play("wave", seconds=0.3).reason == "done"
    assert "walking" in states and not {"limp", "fallen", "faulted"} & set(states)
    assert robot.status.state == "holding" and robot.status.armed


def test_a_walk_is_changed_and_ended_while_it_goes_on(robot: RemoteRobot) -> None:
    number = robot.begin("walk", speed=0.05, steps=1000)
    until(robot, lambda status: status.state == "walking")
    robot.change(speed=0.2, turn=0.1)
    robot.end()
    assert robot.wait(number).reason == "ended by its client"
    assert robot.status.state == "holding"


def test_one_behaviour_can_follow_another_that_goes_on(robot: RemoteRobot) -> None:
    first = robot.begin("stand", seconds=1000.0)
    assert robot.stand(0.2).good
    assert robot.status.state == "holding"
    assert first == 1


def test_a_client_that_leaves_leaves_the_robot_holding(robot: RemoteRobot, base: Path) -> None:
    with RemoteRobot("op3") as leaver:
        leaver.begin("stand", seconds=1000.0)
        until(robot, lambda status: status.state == "standing")
        with pytest.raises(UsageError, match="has op3: wait, or end that first"):
            robot.stand(0.1)
    status = until(robot, lambda status: status.state == "holding")
    assert status.armed and status.holder == ""


def test_goals_are_followed_and_held_when_they_stop(robot: RemoteRobot) -> None:
    before = robot.status.counts
    with robot.stream() as stream:
        while robot.status.counts["stepped"] == before["stepped"]:  # it holds by now
            stream.write(np.zeros(len(robot.joints)))
        status = until(robot, lambda status: status.counts["silent"] > before["silent"])
    assert status.counts["received"] > before["received"]
    assert status.counts["stepped"] > before["stepped"] and status.state == "holding"
    assert robot.stand(0.5).good


def test_wrong_requests_are_refused_and_nothing_moves(robot: RemoteRobot) -> None:
    with pytest.raises(UsageError, match="unknown behaviour 'leap'"):
        robot.run("leap")
    with pytest.raises(UsageError, match="unknown option 'speeed'"):
        robot.run("walk", speeed=0.1)
    with pytest.raises(UsageError, match="outside the range of gait"):
        robot.walk(speed=0.9)
    assert robot.status.state == "holding"


def test_it_is_not_up_twice(base: Path) -> None:
    ran = subprocess.run(command(base, "up", "op3"), capture_output=True, text=True)
    assert ran.returncode == 2
    assert "op3 is up already, on its twin (process" in ran.stderr


def test_a_command_on_a_robot_that_is_up_says_where_first(base: Path) -> None:
    line = ["stand", "op3", "--up", "--seconds", "0.2"]
    ran = subprocess.run(command(base, *line), capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    first, second = ran.stderr.splitlines()
    assert first == "op3 on its twin, armed" and second.startswith("op3 stood for")


def test_after_a_stop_torque_comes_on_only_when_asked_for(robot: RemoteRobot) -> None:
    number = robot.begin("stand", seconds=1000.0)
    until(robot, lambda status: status.state == "standing")
    stopped = robot.stop()
    assert [each.outcome.stopped for each in stopped] == [True]
    assert stopped[0].seconds < 3.0 and "read back" in stopped[0].outcome.said
    assert robot.wait(number).reason == "stopped by `windup stop`"
    assert not until(robot, lambda status: status.state in ("limp", "fallen")).armed
    with pytest.raises(UsageError, match="give --arm to switch its torque on again"):
        robot.stand(0.1)
    report = robot.run("stand", arm=True, seconds=0.1)
    assert report.reason == "it was already lying down: put it on its feet" or report.good


def test_it_goes_down_when_it_is_told_to(monkeypatch: pytest.MonkeyPatch) -> None:
    with tempfile.TemporaryDirectory() as folder, windup_up(Path(folder), "op3") as process:
        monkeypatch.setattr("windup.hal.stopping.folder.BASE", Path(folder))
        with RuntimeClient("op3", "test") as client:
            client.send(Goal(position=()))
            client.down()
        assert process.wait(20.0) == 0
        assert list(Path(folder).glob("*/*")) == []
