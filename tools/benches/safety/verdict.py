"""Judges a trial: time to torque off, torque as the vendor's SDK reads it, exit status."""

import time
from contextlib import suppress
from dataclasses import dataclass
from math import inf

from serial import SerialException

from windup.robots import RobotDescription
from windup.tools.benches.safety.independent import torque_of
from windup.tools.benches.safety.processes import alive
from windup.tools.benches.safety.row import Ending
from windup.tools.benches.safety.trial import AFTERWARDS, LONGEST, Trial

READS, BETWEEN = 4, 0.3
"""Number of attempts of an independent client to read, and the time between them, s."""


@dataclass(frozen=True)
class Verdict:
    """The result of a trial.

    Attributes:
        activity: Activity of the program.
        after: Time from the beginning of the activity to the ending, s.
        seconds: Time from t0 until no motor was driven, s; infinite if never.
        status: Exit status of the program.
        found: State after the end, a row's `end` or a description.
        wrong: Deviations from the expected result; "" for a safe ending.
        words: Output of program and guardian, if something is wrong.
    """

    activity: str
    after: float
    seconds: float
    status: int | None
    found: str
    wrong: str
    words: str = ""


def judge(trial: Trial, row: Ending, robot: RobotDescription, t0: float) -> Verdict:
    """Wait for the end of the trial and return its result."""
    gone = row.end in ("unknown", "unattended")
    seconds = 0.0 if gone or row.end == "frozen" else _undriven(trial, t0)
    trial.program.join(LONGEST)
    status = trial.program.exitcode
    trial.journal.listen(AFTERWARDS)
    found = _found(trial, row, robot)
    wrong = [
        f"driven for {seconds:.2f} s" * (seconds > row.allowed(robot.stop == "crouch")),
        "driven again" * (not gone and row.end == "off" and trial.journal.driven > 0),
        f"exit status {status}" * (status not in row.status),
        found * (found != row.end),
    ]
    said, moment = ", ".join(filter(None, wrong)), trial.moment
    words = trial.last_lines() if said else ""
    return Verdict(moment.activity, moment.after, seconds, status, found, said, words)


def _undriven(trial: Trial, t0: float) -> float:
    """Return the time from t0 until the last motor was no longer driven, s."""
    if not trial.journal.wait_until_still(LONGEST):
        return inf
    trial.program.join(LONGEST)
    trial.journal.listen(AFTERWARDS)
    let_go = [event.time for event in trial.journal.since(t0, "driven")]
    return max([0.0, *(time - t0 for time in let_go)]) if trial.journal.driven == 0 else inf


def _watched(trial: Trial, row: Ending) -> bool:
    """Return whether a guardian is still running after the time in which it should end."""
    until = time.monotonic() + (LONGEST if row.end == "off" else 0.0)
    while alive(trial.guardian) and time.monotonic() < until:
        time.sleep(0.01)
    return alive(trial.guardian)


def _read(trial: Trial, robot: RobotDescription) -> dict[str, int | None]:
    """Return the torque of each joint; a guardian that is still trying may disturb the reading."""
    for _ in range(READS - 1):
        with suppress(OSError, SerialException):
            return torque_of(robot, trial.port)
        time.sleep(BETWEEN)
    return torque_of(robot, trial.port)


def _found(trial: Trial, row: Ending, robot: RobotDescription) -> str:
    """Return the state that an independent client reads, and whether a guardian is left."""
    watched = _watched(trial, row)
    if row.end in ("unknown", "unattended"):
        if not watched and trial.journal.driven == 0:
            return row.end  # torque was off before the adapter died: no guardian is needed
        return "unknown" if watched else "unattended"
    if trial.program.is_alive():
        return "the program goes on"
    try:
        torque = _read(trial, robot) if not row.network else {}
    except (OSError, SerialException) as error:
        return f"the port cannot be read: {error}"
    on = [name for name, value in torque.items() if value == 1]
    if on:
        return f"torque on at {', '.join(on)}"
    if torque and all(value == -1 for value in torque.values()):
        return "frozen"
    silent = [name for name, value in torque.items() if value is None]
    if len(silent) > 1:
        return f"no answer from {', '.join(silent)}"
    if watched and not silent:
        return "off, and a guardian left over"
    return "off"
