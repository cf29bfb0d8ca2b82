"""How a trial is ended: each function returns what makes it happen and says when t0 was."""

import signal
from collections.abc import Callable
from math import inf

from windup.tools.benches.safety.standard_error import fill
from windup.tools.benches.safety.trial import Trial

Do = Callable[[Trial], float]


def press(number: int, times: int = 1, every: float = 0.0) -> Do:
    """Send signals to the program, `every` so many s."""
    return lambda trial: trial.press(number, times, every)


def press_then(number: int, then: int, after: float) -> Do:
    """Send a signal to the program, and another one some time after, s."""

    def do(trial: Trial) -> float:
        when = trial.press(number)
        trial.journal.listen(after)
        trial.press(then)
        return when

    return do


def kill(*who: str, number: int = signal.SIGKILL) -> Do:
    """Send a signal to several processes at once."""
    return lambda trial: trial.kill(*who, number=number)


def kill_unread(trial: Trial) -> float:
    """Kill the program when the pipe is full that it and its guardian print to."""
    fill(trial.log)
    return trial.kill("program")


def own_fault(trial: Trial) -> float:
    """Wait until the program does something wrong by itself."""
    return trial.hear("fault")[1]


def inject(faults: dict[str, str]) -> Do:
    """Let something go wrong on the bus: robot to faults, "" for all other robots."""
    return lambda trial: trial.inject(faults.get(trial.robot, faults.get("", "")))


def unplug(seconds: float) -> Do:
    """Pull out the adapter for some time, s; t0 is when it is back, or now if it never is."""

    def do(trial: Trial) -> float:
        when = trial.inject(f"unplug:seconds={seconds:g}")
        return when if seconds == inf else trial.wait_for("plugged", seconds + 2.0)

    return do


def brown_out(seconds: float) -> Do:
    """Take the servos' supply away for some time, s; t0 is when it is back."""

    def do(trial: Trial) -> float:
        trial.inject(f"brown_out:volts=0:seconds={seconds:g}")
        trial.wait_for("supply", 2.0)
        return trial.wait_for("supply", seconds + 2.0)

    return do
