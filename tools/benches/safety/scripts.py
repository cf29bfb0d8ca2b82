"""Behaviour of the program: it stands, walks, crouches, or is written carelessly."""

import os
import threading
import time
from collections.abc import Callable

from windup.hal.errors import WindupError
from windup.hal.observation import Observation
from windup.tools.benches.safety.fault_timer import FaultTimer
from windup.tools.benches.safety.moment import Activity
from windup.tools.robot.robot import Robot

BY_ITSELF = "its walk ended by itself"
FOR_EVER = 3600.0
"""Longer than any trial, s."""
WARM_UP = 0.4
"""Time from the end of the first motion until the robot stands still, s."""

Body = Callable[[Robot, Activity, FaultTimer], None]


def move(robot: Robot, activity: Activity, begin: FaultTimer) -> None:
    """Stand, walk, or perform the closing crouch."""
    if activity == "walking":
        robot.walk(steps=1000, on_step=[lambda number, _: begin.now("walking")])
        raise WindupError(f"{BY_ITSELF}: {robot.loop.reason}")
    robot.stand(WARM_UP)
    robot.watch.insert(0, lambda _: begin.now(activity))
    if activity == "closing crouch":
        robot.rest()
    else:
        robot.stand(FOR_EVER)


def _goes_on(robot: Robot, activity: Activity, begin: FaultTimer) -> None:
    """Catch Ctrl-C, and try to continue."""
    try:
        move(robot, activity, begin)
    except KeyboardInterrupt:
        robot.stand(FOR_EVER)


def _in_a_thread(robot: Robot, activity: Activity, begin: FaultTimer) -> None:
    """Run in another thread, while the main thread only waits."""
    thread = threading.Thread(target=move, args=(robot, activity, begin))
    thread.start()
    thread.join()


def _leaves(robot: Robot, activity: Activity, begin: FaultTimer) -> None:
    """Exit between two calls, without closing the robot."""
    robot.stand(WARM_UP)
    begin.now("standing")
    _sleep(begin)


def _leaves_at_once(robot: Robot, activity: Activity, begin: FaultTimer) -> None:
    """Exit between two calls by `os._exit`, without any clean-up of Python."""
    robot.stand(WARM_UP)
    begin.now("standing")
    _sleep(begin)
    os._exit(7)


def _sleep(begin: FaultTimer) -> None:
    while not begin.due():
        time.sleep(0.01)


def _nobody_reads(robot: Robot, activity: Activity, begin: FaultTimer) -> None:
    """Print to a pipe whose reader has closed it."""
    reading, writing = os.pipe()
    os.close(reading)

    def watch(observation: Observation) -> None:
        if begin.due():
            os.write(writing, b"step\n")

    robot.watch.append(watch)
    move(robot, activity, begin)


def _loop_over_ticks(fault: Callable[[], None] | None = None) -> Body:
    """Return a program whose controller is the body of a `for` loop, and fails there."""

    def loop(robot: Robot, activity: Activity, begin: FaultTimer) -> None:
        robot.stand(WARM_UP)
        for _ in robot.ticks():
            begin.now(activity)
            if fault is not None and begin.due():
                fault()

    return loop


def _block() -> None:
    time.sleep(0.3)


def _raise() -> None:
    raise ValueError("a bug in the body of the loop")


SCRIPTS: dict[str, Body] = {
    "goes on after Ctrl-C": _goes_on,
    "runs in a thread": _in_a_thread,
    "exits between two calls": _leaves,
    "os._exit": _leaves_at_once,
    "nobody reads its output": _nobody_reads,
    "loops over ticks": _loop_over_ticks(),
    "its loop blocks 0.3 s": _loop_over_ticks(_block),
    "its loop raises": _loop_over_ticks(_raise),
}
LEFT_OPEN = ("exits between two calls", "os._exit")
"""Scripts that never close their robot."""
