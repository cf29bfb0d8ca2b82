"""Ways to end a trial: each function makes one, which acts on a trial and returns t0."""

import signal
from collections.abc import Callable
from math import inf

from windup.tools.benches.safety.standard_error import fill
from windup.tools.benches.safety.trial import Trial

Do = Callable[[Trial], float]


def press(number: int, times: int = 1, every: float = 0.0) -> Do:
    """Send a signal to the program `times` times, at intervals of `every` s."""
    return lambda trial: trial.press(number, times, every)


def press_then(number: int, then: int, after: float) -> Do:
    """Send a signal to the program, and another one `after` s later."""

    def do(trial: Trial) -> float:
        when = trial.press(number)
        trial.journal.listen(after)
        trial.press(then)
        return when

    return do


def kill(*who: str, number: int = signal.SIGKILL) -> Do:
    """Send a signal to several processes at the same time."""
    return lambda trial: trial.kill(*who, number=number)


def kill_unread(trial: Trial) -> float:
    """Kill the program while the pipe to which it and its guardian print is full."""
    fill(trial.log)
    return trial.kill("program")


def own_fault(trial: Trial) -> float:
    """Wait until the fault of the program itself happens."""
    return trial.wait_for_message("fault")[1]


def inject(faults: dict[str, str]) -> Do:
    """Inject faults into the bus; `faults` maps robots to texts, "" to that of all other robots."""
    return lambda trial: trial.inject(faults.get(trial.robot, faults.get("", "")))


def unplug(seconds: float) -> Do:
    """Pull out the adapter for `seconds`; t0 is when it is back, or now if it never is."""

    def do(trial: Trial) -> float:
        when = trial.inject(f"unplug:seconds={seconds:g}")
        return when if seconds == inf else trial.wait_for("plugged", seconds + 2.0)

    return do


def brown_out(seconds: float) -> Do:
    """Interrupt the servos' supply for `seconds`; t0 is when it is back."""

    def do(trial: Trial) -> float:
        trial.inject(f"brown_out:volts=0:seconds={seconds:g}")
        trial.wait_for("supply", 2.0)
        return trial.wait_for("supply", seconds + 2.0)

    return do
