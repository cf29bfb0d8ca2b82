"""Requests to stop that come while the body of a loop over ticks has the robot."""

import signal
from collections.abc import Iterator

import pytest

from tests.tools.robot.worlds import WORLDS
from windup import Robot
from windup.hal.errors import UsageError
from windup.tools.stopping.interrupts import RunInterruptedError, forget_interruption


def ctrl_c(times: int = 1) -> None:
    for _ in range(times):
        signal.raise_signal(signal.SIGINT)


@pytest.fixture(autouse=True)
def handler() -> Iterator[None]:
    forget_interruption()
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
    forget_interruption()


@pytest.fixture(params=WORLDS)
def robot(request: pytest.FixtureRequest) -> Iterator[Robot]:
    with WORLDS[request.param]() as robot:
        yield robot


def test_ctrl_c_in_the_body_stops_the_robot_at_the_next_tick(robot: Robot) -> None:
    ticks, passes = robot.ticks(), 0
    with pytest.raises(RunInterruptedError, match="stopped by Ctrl-C") as stopped:
        for _ in ticks:
            passes += 1
            ctrl_c()
    assert passes == 1 and not robot.armed
    assert stopped.value.report is ticks.report and ticks.report.reason == "interrupted"


def test_the_third_ctrl_c_interrupts_a_body_that_does_not_end(robot: Robot) -> None:
    with pytest.raises(KeyboardInterrupt):
        for _ in robot.ticks():
            ctrl_c(3)
            raise AssertionError("it goes on")
    assert robot.loop.reason == "interrupted" and not robot.armed
    with pytest.raises(RunInterruptedError):
        robot.stand(0.1)


def test_ctrl_c_in_a_body_that_leaves_the_loop_stops_the_robot_and_is_raised_next(
    robot: Robot,
) -> None:
    for _ in robot.ticks():
        ctrl_c()
        break
    assert robot.loop.reason == "interrupted" and not robot.armed
    with pytest.raises(RunInterruptedError, match="Ctrl-C"):
        robot.read()
    robot.read()


def test_ctrl_c_in_the_last_body_is_raised_at_the_end_of_the_with() -> None:
    for world in WORLDS.values():
        forget_interruption()
        with pytest.raises(RunInterruptedError), world() as robot:
            for _ in robot.ticks():
                ctrl_c()
                break


def test_a_stop_in_the_body_ends_the_loop_and_stops_the_robot(robot: Robot) -> None:
    with pytest.raises(RunInterruptedError, match=r"robot\.stop\(\)"):
        for _ in robot.ticks():
            robot.stop()
    assert not robot.armed


def test_after_ctrl_c_nothing_arms_by_itself() -> None:
    with WORLDS["wire"]() as robot:
        with pytest.raises(RunInterruptedError):
            for _ in robot.ticks():
                ctrl_c()
        with pytest.raises(UsageError, match=r"call robot\.arm\(\)"):
            list(robot.ticks(seconds=0.1))
        forget_interruption()
