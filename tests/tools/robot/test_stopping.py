"""Endings that a program brings about itself, on emulated servos."""

import asyncio
import os
import signal
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from threading import Event, Thread, current_thread, main_thread

import pytest

from windup.hal.errors import UsageError
from windup.hal.observation import Observation
from windup.tools.robot.robot import Robot
from windup.tools.stopping.interrupts import RunInterruptedError, forget_interruption
from windup.tools.testing.servo_bus import ServoBus


def driving(bus: ServoBus) -> bool:
    return any(device.driving for device in bus.world.devices)


def ctrl_c() -> None:
    assert current_thread() is main_thread()
    signal.raise_signal(signal.SIGINT)


@pytest.fixture
def bus() -> Iterator[ServoBus]:
    forget_interruption()
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    with ServoBus("duck") as bus:
        yield bus
    signal.signal(signal.SIGINT, before)
    forget_interruption()


def test_close_rests_and_once_more_is_no_matter(bus: ServoBus) -> None:
    robot = bus.robot()
    robot.stand(0.2)
    assert driving(bus)
    robot.close()
    robot.close()
    assert not robot.armed and not driving(bus)


@pytest.mark.parametrize("call", ["arm", "rearm", "stop", "stand", "rest"])
def test_a_closed_robot_says_so(bus: ServoBus, call: str) -> None:
    robot = bus.robot()
    robot.close()
    with pytest.raises(UsageError, match=r"duck is closed: open it with Robot\.open"):
        getattr(robot, call)()


def test_ctrl_c_between_two_calls_that_is_caught_stops_the_robot(bus: ServoBus) -> None:
    robot = bus.robot()
    robot.stand(0.2)
    with pytest.raises(KeyboardInterrupt):
        ctrl_c()
    with pytest.raises(UsageError, match=r"Ctrl-C has stopped this program.*call robot\.arm\(\)"):
        robot.stand(1.0)
    assert not robot.armed and not driving(bus)


def test_ctrl_c_before_torque_came_on_keeps_it_off(bus: ServoBus) -> None:
    robot = bus.robot()
    with pytest.raises(KeyboardInterrupt):
        ctrl_c()
    with pytest.raises(UsageError, match=r"call robot\.arm\(\)"):
        robot.stand(1.0)
    assert not driving(bus)


def test_ctrl_c_while_somebody_looks_how_the_robot_is_keeps_torque_off(
    bus: ServoBus, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = bus.robot()
    assert robot.start is not None
    monkeypatch.setattr(robot.start, "check", lambda down: ctrl_c())
    with pytest.raises(RunInterruptedError):
        robot.stand(1.0)
    assert not robot.armed and not driving(bus)
    with pytest.raises(UsageError, match=r"call robot\.arm\(\)"):
        robot.stand(1.0)


def test_ctrl_c_between_an_armed_robot_and_its_first_tick_stops_it(
    bus: ServoBus, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = bus.robot()
    robot.stand(0.2)
    assert robot.armed
    monkeypatch.setattr(robot.session, "guarded_estimator", lambda needs_imu: ctrl_c())
    with pytest.raises(RunInterruptedError):
        robot.stand(1.0)
    assert not robot.armed and not driving(bus)


def test_ctrl_c_while_torque_comes_on_switches_it_off_again(
    bus: ServoBus, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = bus.robot()
    switch = robot.backend.set_torque

    def interrupted(on: bool) -> object:
        state = switch(on)
        if on:
            ctrl_c()
        return state

    monkeypatch.setattr(robot.backend, "set_torque", interrupted)
    with pytest.raises(RunInterruptedError):
        robot.arm()
    assert not robot.armed and not driving(bus)


def test_ctrl_c_in_a_stop_keeps_torque_off_afterwards(
    bus: ServoBus, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = bus.robot()
    robot.stand(0.2)
    stop = robot.backend.stop

    def interrupted(*arguments: object) -> object:
        ctrl_c()
        return stop(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(robot.backend, "stop", interrupted)
    with pytest.raises(RunInterruptedError):
        robot.stop()
    with pytest.raises(UsageError, match=r"call robot\.arm\(\)"):
        robot.stand(1.0)
    assert not driving(bus)


def test_ctrl_c_stops_a_run_in_another_thread(bus: ServoBus) -> None:
    robot, begun = bus.robot(), Event()
    robot.watch.append(lambda observation: begun.set())
    with ThreadPoolExecutor() as executor:
        run = executor.submit(robot.stand, 3600.0)
        assert begun.wait(20.0)
        with pytest.raises(KeyboardInterrupt):
            ctrl_c()
        with pytest.raises(RunInterruptedError, match="Ctrl-C"):
            run.result(20.0)
    assert not driving(bus)


@pytest.mark.parametrize("error", [asyncio.CancelledError, GeneratorExit])
def test_whatever_a_callback_raises_stops_the_robot(
    bus: ServoBus, error: type[BaseException]
) -> None:
    robot = bus.robot()

    def watch(observation: Observation) -> None:
        raise error

    robot.watch.append(watch)
    with pytest.raises(error):
        robot.stand(1.0)
    assert error.__name__ in robot.loop.reason
    assert not robot.armed and not driving(bus)


def test_a_run_in_a_run_is_refused_and_stops_the_robot(bus: ServoBus) -> None:
    robot = bus.robot()

    def watch(observation: Observation) -> None:
        robot.stand(0.2)

    robot.watch.append(watch)
    with pytest.raises(UsageError, match="already running"):
        robot.stand(1.0)
    assert not driving(bus)


def test_a_run_beside_a_run_is_refused(bus: ServoBus) -> None:
    robot, begun = bus.robot(), Event()
    robot.watch.append(lambda observation: begun.set())

    def run() -> None:
        with pytest.raises(KeyboardInterrupt):
            robot.stand(3600.0)

    thread = Thread(target=run)
    thread.start()
    assert begun.wait(20.0)
    with pytest.raises(UsageError, match="already running"):
        robot.stand(1.0)
    robot.stop()
    thread.join(20.0)
    assert not thread.is_alive() and not driving(bus)


def test_a_run_that_stops_the_robot_itself_ends(bus: ServoBus) -> None:
    robot = bus.robot()
    robot.watch.append(lambda observation: robot.stop())
    with pytest.raises(RunInterruptedError, match=r"robot\.stop\(\)"):
        robot.stand(3600.0)
    assert not robot.armed and not driving(bus)


def test_a_forked_child_leaves_its_parents_robot_alone(bus: ServoBus) -> None:
    robot = bus.robot()
    robot.stand(0.2)
    child = os.fork()
    if child == 0:
        refused = 1
        try:
            robot.stand(0.1)
        except UsageError as error:
            refused = "belongs to the process that opened it" not in str(error)
        finally:
            os._exit(int(refused))
    assert os.waitpid(child, 0)[1] == 0
    assert driving(bus) and robot.stand(0.1).reason == "done"
    robot.close()


def test_a_stop_in_the_first_motion_goes_limp(bus: ServoBus) -> None:
    robot: Robot = bus.robot()
    robot.watch.append(lambda observation: robot.stop())
    began = bus.clock.now()
    with pytest.raises(RunInterruptedError):
        robot.stand(3600.0)
    assert bus.clock.now() - began < 1.0 + 0.5, "no time for the look and a crouch"
    assert not driving(bus)
