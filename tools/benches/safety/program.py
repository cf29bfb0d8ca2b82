"""The process that is ended: a user's program with a robot."""

import atexit
import os
import sys
from contextlib import ExitStack
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

from windup.hal.errors import WindupError
from windup.tools.benches.safety.fault_timer import FaultTimer
from windup.tools.benches.safety.faulty import FAULTS, break_imu, make_faulty
from windup.tools.benches.safety.moment import Activity
from windup.tools.benches.safety.scripts import LEFT_OPEN, SCRIPTS, move
from windup.tools.benches.safety.standard_error import Errors, replace_standard_error
from windup.tools.robot.robot import Robot
from windup.tools.stopping.interrupts import end_on_signals
from windup.tools.terminal.output import console


@dataclass(frozen=True)
class Program:
    """Description of the program.

    Attributes:
        robot: Name of the robot.
        port: Its port.
        arm: Whether it may switch torque on.
        errors: Kind of its standard error, which its guardian shares.
        log: Path of the file or pipe for standard error.
        activity: Its activity when it is ended.
        fault: Its own fault: a name of `FAULTS` or `SCRIPTS`, "imu nan", or "".
        after: Time from the beginning of the activity to the fault, s.
    """

    robot: str
    port: str
    activity: Activity
    fault: str = ""
    after: float = 0.0
    arm: bool = True
    errors: Errors = "a file"
    log: Path = Path(os.devnull)


def main(program: Program, tell: Connection) -> None:
    """Run a program; the main function of the process, whose exit status is that of a command."""
    end_on_signals()
    replace_standard_error(program.errors, program.log)
    status = 0
    try:
        _run(program, tell)
        tell.send(("ended", "by itself"))
    except WindupError as error:
        tell.send(("error", str(error)))
        console.print(f"windup: {error}", markup=False, soft_wrap=True)
        status = error.exit_status
    except KeyboardInterrupt:
        status = 130
    atexit._run_exitfuncs()  # a process of multiprocessing skips them, an ordinary program does not
    sys.exit(status)


def _run(program: Program, tell: Connection) -> None:
    begin = FaultTimer(tell, program.after)
    robot = Robot.open(program.robot, port=program.port, arm=program.arm)
    with ExitStack() as stack:
        if program.fault not in LEFT_OPEN:
            stack.enter_context(robot)
        if program.fault in FAULTS:
            make_faulty(robot, FAULTS[program.fault], begin)
        if program.fault == "imu nan":
            break_imu(robot, begin)
        SCRIPTS.get(program.fault, move)(robot, program.activity, begin)
