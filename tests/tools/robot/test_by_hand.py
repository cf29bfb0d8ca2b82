"""Reads and writes outside of a run."""

import logging
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from tests.tools.robot.worlds import WORLDS, head, on_servos, on_the_twin, turned
from windup import JointCommand, Robot
from windup.hal.errors import UnsafeCommandError, UsageError


@pytest.fixture(params=WORLDS)
def robot(request: pytest.FixtureRequest) -> Iterator[Robot]:
    with WORLDS[request.param]() as robot:
        yield robot


def test_a_loop_of_reads_and_writes_goes_on_tick_by_tick(robot: Robot) -> None:
    robot.stand(0.1)
    times = []
    for _ in range(60):
        times.append(robot.read().time)
        robot.write(turned(robot, 0.3))
    np.testing.assert_allclose(np.diff(times), robot.period, atol=robot.period / 4)
    assert head(robot) == pytest.approx(0.3, abs=0.1)
    assert robot.loop.ticks == 60 and robot.loop.missed == 0


def test_a_loop_that_only_writes_goes_on_too() -> None:
    with on_the_twin() as robot:
        began = robot.read().time
        for _ in range(10):
            robot.write(turned(robot, 0.1))
        assert robot.read().time == pytest.approx(began + 10 * robot.period)


def test_a_read_has_the_base_state() -> None:
    with Robot.open("op3", state="estimated") as robot:
        base = robot.read().base
        assert base is not None and base.position[2] == pytest.approx(0.27, abs=0.05)


def test_the_same_instant_twice_is_said_once(caplog: pytest.LogCaptureFixture) -> None:
    with on_the_twin() as robot:
        robot.read()
        assert caplog.messages == []
        for _ in range(3):
            robot.read()
        (said,) = caplog.messages
        assert "same instant twice" in said and "robot.ticks()" in said


def test_a_read_after_a_write_is_not_the_same_instant(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.WARNING)
    with on_the_twin() as robot:
        for _ in range(3):
            robot.read()
            robot.write(turned(robot, 0.1))
    assert caplog.messages == []


def test_time_passes_by_itself_on_servos(caplog: pytest.LogCaptureFixture) -> None:
    with on_servos("duck") as duck:
        assert duck.read().time < duck.read().time
    assert caplog.messages == []


def test_joints_without_torque_are_not_written_to_and_what_to_call_is_said() -> None:
    with on_servos("duck") as duck:
        command = turned(duck, 0.1)
        with pytest.raises(UsageError, match=r"torque of duck is off: call robot\.stand\(\)"):
            duck.write(command)
        duck.arm()
        with pytest.raises(UsageError, match=r"first motion: call robot\.stand\(\)"):
            duck.write(command)
        duck.stand(0.1)
        assert duck.write(command).position == pytest.approx(command.position, abs=0.01)
        duck.stop(limp=True)
        duck.stack = replace(duck.stack, may_arm=False)
        with pytest.raises(UsageError, match=r"open it with Robot\.open\(\.\.\., arm=True\)"):
            duck.write(command)


def test_what_the_guard_refuses_stops_the_robot() -> None:
    with on_servos("duck") as duck:
        duck.stand(0.1)
        wrong = JointCommand.of(duck.joints, position=np.full(len(duck.joints), np.nan))
        with pytest.raises(UnsafeCommandError):
            duck.write(wrong)
        assert not duck.armed


@pytest.mark.parametrize("call", ["read", "ticks"])
def test_a_closed_robot_says_so(robot: Robot, call: str) -> None:
    robot.close()
    with pytest.raises(UsageError, match=r"op3 is closed: open it with Robot\.open"):
        list(getattr(robot, call)())
    with pytest.raises(UsageError, match="op3 is closed"):
        robot.write(turned(robot, 0.1))


@pytest.mark.parametrize("call", ["run", "arm", "rearm"])
def test_the_torque_of_a_twin_comes_back_after_a_stop(call: str) -> None:
    with on_the_twin() as robot:
        robot.stand(0.1)
        robot.stop()
        assert not robot.twin.powered
        with pytest.raises(UsageError, match="the torque of op3 is off: call"):
            robot.write(turned(robot, 0.1))
        if call != "run":
            getattr(robot, call)()
            assert robot.twin.powered
        assert robot.stand(1.0).reason == "done"


def test_a_refused_command_leaves_a_twin_that_stands_again() -> None:
    with on_the_twin() as robot:
        with pytest.raises(UnsafeCommandError):
            robot.write(turned(robot, float("nan")))
        assert robot.stand(1.0).reason == "done"
