import signal
import threading
from collections.abc import Iterator

import pytest

from windup.hal.errors import UsageError
from windup.hal.observation import Observation
from windup.tools.robot.robot import Robot
from windup.tools.stopping.interrupts import (
    RunInterruptedError,
    check_not_interrupted,
    counted_signals,
    forget_interruption,
    note_interruption,
)
from windup.tools.testing.servo_bus import ServoBus


@pytest.fixture(autouse=True)
def forgive() -> Iterator[None]:
    yield
    forget_interruption()


def press(number: int = signal.SIGINT, times: int = 1) -> None:
    for _ in range(times):
        signal.raise_signal(number)  # to this very thread: others would hear them late, as one


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (signal.SIGINT, "Ctrl-C"),
        (signal.SIGTERM, "SIGTERM"),
        (signal.SIGHUP, "the end of the terminal"),
        (signal.SIGQUIT, "Ctrl-\\"),
        (signal.SIGTSTP, "Ctrl-Z"),
    ],
)
def test_signals_are_counted_and_interrupt_nothing(number: int, words: str) -> None:
    with counted_signals() as requests:
        assert not requests()
        press(number, 5)
        assert requests() and requests.count == 5
        assert requests.by == words


def test_the_third_signal_is_impatient() -> None:
    with counted_signals() as requests:
        press(times=2)
        assert not requests.skip_crouch
        press()
        assert requests.skip_crouch


def test_afterwards_ctrl_c_is_an_exception_again_and_ctrl_z_suspends() -> None:
    with counted_signals():
        pass
    assert signal.getsignal(signal.SIGTSTP) is signal.SIG_DFL
    with pytest.raises(KeyboardInterrupt):
        press()


def test_a_twin_can_still_be_suspended() -> None:
    with counted_signals(wired=False):
        assert signal.getsignal(signal.SIGTSTP) is signal.SIG_DFL


def test_what_counts_inside_counts_outside() -> None:
    with counted_signals() as outer:
        with counted_signals() as inner:
            press()
        assert inner is outer and outer()


def test_another_thread_is_asked_by_the_end_of_the_main_thread_alone() -> None:
    heard: list[bool] = []

    def ask() -> None:
        with counted_signals() as requests:
            heard.append(requests())

    thread = threading.Thread(target=ask)
    thread.start()
    thread.join()
    assert heard == [False]


def test_nothing_arms_by_itself_in_a_program_that_was_told_to_end() -> None:
    note_interruption("Ctrl-C")
    with pytest.raises(UsageError, match=r"Ctrl-C has stopped this program.*robot\.arm\(\)"):
        check_not_interrupted()
    forget_interruption()
    check_not_interrupted()


def interrupted(robot: Robot, at: float = 2.2, times: int = 1) -> None:
    """Press Ctrl-C once the run has gone on for so long, s."""

    def watch(observation: Observation) -> None:
        if observation.time > at:
            robot.watch.clear()
            press(times=times)

    robot.watch.append(watch)


def test_ctrl_c_stops_the_robot_then_raises_with_the_report() -> None:
    with ServoBus("op3") as bus:
        robot = bus.robot()
        interrupted(robot)
        with pytest.raises(RunInterruptedError, match="stopped by Ctrl-C") as stopped:
            robot.stand(2.0)
        assert stopped.value.report is robot.loop
        assert robot.loop.reason == "interrupted" and robot.loop.ticks > 10
        assert not any(device.driving for device in bus.world.devices)


def test_a_script_that_goes_on_after_ctrl_c_moves_nothing_until_it_arms_again() -> None:
    with ServoBus("op3") as bus:
        robot = bus.robot()
        interrupted(robot)
        with pytest.raises(KeyboardInterrupt):
            robot.stand(2.0)
        with pytest.raises(UsageError, match=r"call robot\.arm\(\)"):
            robot.stand(2.0)
        assert not any(device.driving for device in bus.world.devices)
        robot.arm()
        robot.twin.reset(robot.description.stance)  # somebody puts it on its feet
        assert robot.stand(0.2).reason == "done"


def test_three_signals_leave_out_the_crouch() -> None:
    def seconds(times: int) -> float:
        with ServoBus("duck") as bus:
            robot = bus.robot()
            interrupted(robot, times=times)
            with pytest.raises(KeyboardInterrupt):
                robot.stand(2.0)
            forget_interruption()
            return bus.clock.now()

    assert seconds(1) - seconds(3) > 1.0


def test_a_run_in_another_thread_is_ended_by_stop() -> None:
    with ServoBus("op3") as bus:
        robot = bus.robot()
        began = threading.Event()
        ended: list[BaseException] = []

        def run() -> None:
            robot.watch.append(lambda observation: began.set())
            try:
                robot.stand(1e6)
            except KeyboardInterrupt as error:
                ended.append(error)

        thread = threading.Thread(target=run)
        thread.start()
        began.wait()
        robot.stop()
        thread.join()
        assert str(ended[0]) == "stopped by robot.stop()"
        assert not any(device.driving for device in bus.world.devices)
