"""`windup stop` for runs that are under way: by their stop flags, without opening a port.

This module and what it imports load neither NumPy nor tyro: the command acts sooner.
"""

import json
import sys
import time
import tomllib
from collections.abc import Sequence
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple

from windup.hal.errors import UsageError
from windup.hal.stopping.folder import folders_to_search, other_users
from windup.hal.stopping.process_start import process_start
from windup.hal.stopping.stop_flag import TIME_TO_ANSWER, Outcome, StopFlag, flags_in
from windup.tools.terminal.command import Command
from windup.tools.terminal.result import SCHEMA, print_result
from windup.tools.terminal.writing import STANDARD_OUTPUT, writing

LOOK: Final = 0.001
"""Time between two looks at a flag, s."""
LONGEST: Final = 10.0
"""Maximum time to wait for the end of a stop, which may be a crouch, s."""
NOBODY_LEFT: Final = (
    "its program and its guardian have died, so torque may be on: cut the servo power, "
    "or give --port"
)
IGNORED: Final = 15 * TIME_TO_ANSWER
"""Time after which a run without a guardian is taken to hang, ns; arming takes a second."""


class Stopped(NamedTuple):
    """A run that was told to stop.

    Attributes:
        robot: Name of its robot.
        port: Its port; None for a twin.
        pid: Its process id.
        seconds: Time until the outcome was known, s.
        outcome: What became of it.
    """

    robot: str
    port: str | None
    pid: int
    seconds: float
    outcome: Outcome

    def __str__(self) -> str:
        where = "its twin" if self.port is None else self.port
        return f"{self.robot} on {where} (process {self.pid}): {self.outcome.said}"

    def record(self) -> dict[str, Any]:
        """Return it as plain data."""
        outcome = self.outcome
        return {
            "robot": self.robot,
            "port": self.port,
            "pid": self.pid,
            "stopped": outcome.stopped,
            "still_on": list(outcome.still_on),
            "unknown": list(outcome.unknown),
            "by": outcome.by,
            "said": outcome.said,
            "seconds": round(self.seconds, 4),
        }


@dataclass(frozen=True, kw_only=True)
class Stop(Command):
    """Stop the runs of one robot, or all runs of this user.

    Attributes:
        robot: Name of the robot, or path of its folder; None for all.
        json: File for the result, "-" for standard output.
    """

    robot: str | None
    json: Path | None = None

    def run(self) -> int:
        """Stop; return the exit status.

        Raises:
            UsageError: Nothing runs the robot.
        """
        name = None if self.robot is None else robot_name(self.robot)
        stopped = stop_runs(name)
        if not stopped and name is not None:
            raise UsageError(
                f"nothing of yours runs {name}{_others()}; "
                f"`windup stop {name} --port URL` switches its servos off all the same"
            )
        for each in stopped:
            print(each, file=sys.stderr)
        if not stopped:
            print("nothing of yours runs", file=sys.stderr)
        self._write([each.record() for each in stopped])
        return 0 if all(each.outcome.stopped for each in stopped) else 3

    def _write(self, rows: list[dict[str, Any]]) -> None:
        if self.json is None:
            return
        result = rows[0] if len(rows) == 1 and self.robot is not None else {"rows": rows}
        text = json.dumps({"schema": SCHEMA, "command": "stop", **result}, indent=2) + "\n"
        if self.json == STANDARD_OUTPUT:
            print_result(text)
            return
        with writing(self.json):
            self.json.write_text(text, encoding="utf-8")


def parse_stop(words: Sequence[str]) -> Stop | None:
    """Return the command of the words after `stop`; None if they need the full parser.

    >>> parse_stop(["op3", "--json", "-"]).robot
    'op3'
    >>> parse_stop(["op3", "--port", "/dev/ttyUSB0"]) is None
    True
    """
    left, target = list(words), None
    if "--json" in left[:-1]:
        at = left.index("--json")
        target = Path(left[at + 1])
        del left[at : at + 2]
    if left == ["--all"]:
        return Stop(robot=None, json=target)
    if len(left) == 1 and not left[0].startswith("-"):
        return Stop(robot=left[0], json=target)
    return None


def robot_name(name_or_path: str) -> str:
    """Return the name of a robot that is given by its name, or by the path of its folder."""
    with suppress(OSError, tomllib.TOMLDecodeError, UnicodeDecodeError, KeyError, ValueError):
        text = Path(name_or_path, "robot.toml").read_text(encoding="utf-8")
        return str(tomllib.loads(text)["name"])
    return Path(name_or_path).name


def stop_runs(robot: str | None) -> list[Stopped]:
    """Stop the runs of a robot, all runs for None; return what became of each.

    A run that does not see the request within 0.1 s is killed and stopped by its guardian.
    """
    with ExitStack() as stack:
        flags = _flags_of(robot, stack)
        stamps = [flag.request() for flag in flags]  # all, before any is waited for
        return [_wait(flag, stamp) for flag, stamp in zip(flags, stamps, strict=True)]


def runs_on(robot: str, port: str) -> bool:
    """Return whether something of this user runs a robot on a port."""
    with ExitStack() as stack:
        return any(flag.about.port == port for flag in _flags_of(robot, stack))


def _flags_of(robot: str | None, stack: ExitStack) -> list[StopFlag]:
    """Return the flags of the runs of a robot, all for None; they are closed with the stack."""
    flags = [flag for folder in folders_to_search() for flag in flags_in(folder)]
    for flag in flags:
        stack.callback(flag.close)
    return [
        flag
        for flag in flags
        if (robot is None or flag.about.robot == robot) and (flag.alive or flag.guardian)
    ]


def _wait(flag: StopFlag, stamp: int) -> Stopped:
    """Wait until a request has been carried out, or cannot be."""
    outcome = None
    while outcome is None:
        outcome = flag.outcome if flag.done(stamp) else _hopeless(flag, stamp)
        if outcome is None:
            time.sleep(LOOK)
    about, seconds = flag.about, 1e-9 * (time.monotonic_ns() - stamp)
    return Stopped(about.robot, about.port, flag.pid, seconds, outcome)


def _hopeless(flag: StopFlag, stamp: int) -> Outcome | None:
    """Return an outcome where waiting longer is of no use, or None."""
    passed = time.monotonic_ns() - stamp
    if flag.guardian and not flag.alive and not process_start(flag.guardian):
        return flag.outcome or Outcome(said=NOBODY_LEFT, stopped=False)
    if flag.guardian == 0 and not flag.seen(stamp) and passed > IGNORED:
        return Outcome(said="it does not answer; none of its servos has torque")
    if flag.guardian == 0 and not flag.alive:
        return Outcome(said="it has ended; its torque was read back as off")
    if passed > 1e9 * LONGEST:
        return Outcome(
            said=f"torque is not known to be off after {LONGEST:g} s: cut the servo power",
            stopped=False,
        )
    return None


def _others() -> str:
    """Return a remark about other users whose runs this user cannot stop; "" without any."""
    users = other_users()
    if not users:
        return ""
    return f" (user {users[0]} uses Windup on this computer too: `sudo windup stop` reaches all)"
