"""The `windup` command: parse, run, and turn errors into one line and an exit status."""

import io
import logging
import os
import sys
from contextlib import redirect_stderr, redirect_stdout, suppress
from pathlib import Path
from typing import Annotated, Any

import mujoco
import tyro

from hal.errors import UnwellError, UsageError, WindupError
from tools.bench import Bench
from tools.emulate import Emulate
from tools.estimate import Estimate
from tools.footprints import Footprints
from tools.health import Health
from tools.interrupts import end_on_signals, ignore_signals
from tools.output import check_writable, console, error_record, write_json
from tools.parse_errors import wrong_number
from tools.play import Play
from tools.push import Push
from tools.reproduce import Reproduce
from tools.rise import Rise
from tools.robots_list import Robots
from tools.run_notes import NOTES
from tools.scan import Scan
from tools.stand import Stand
from tools.step import Step
from tools.stop import Stop
from tools.stride import Stride
from tools.sweep import Sweep, separate
from tools.synthesis import Synthesise
from tools.walk import Walk

Command = (
    Annotated[Walk, tyro.conf.subcommand("walk")]
    | Annotated[Play, tyro.conf.subcommand("play")]
    | Annotated[Stand, tyro.conf.subcommand("stand")]
    | Annotated[Rise, tyro.conf.subcommand("rise")]
    | Annotated[Push, tyro.conf.subcommand("push")]
    | Annotated[Step, tyro.conf.subcommand("step")]
    | Annotated[Footprints, tyro.conf.subcommand("footprints")]
    | Annotated[Stride, tyro.conf.subcommand("stride")]
    | Annotated[Stop, tyro.conf.subcommand("stop")]
    | Annotated[Scan, tyro.conf.subcommand("scan")]
    | Annotated[Emulate, tyro.conf.subcommand("emulate")]
    | Annotated[Health, tyro.conf.subcommand("health")]
    | Annotated[Robots, tyro.conf.subcommand("robots")]
    | Annotated[Estimate, tyro.conf.subcommand("estimate")]
    | Annotated[Bench, tyro.conf.subcommand("bench")]
    | Annotated[Sweep, tyro.conf.subcommand("sweep")]
    | Annotated[Reproduce, tyro.conf.subcommand("reproduce")]
    | Annotated[Synthesise, tyro.conf.subcommand("synthesise")]
)


def main(arguments: list[str] | None = None) -> None:
    """Run the command line; does not return."""
    status = run(arguments)
    ignore_signals()
    sys.exit(status)


def run(arguments: list[str] | None = None) -> int:
    """Run the command line and return the exit status."""
    logging.basicConfig(level=logging.WARNING, format="windup: %(message)s")
    # MuJoCo would write its warnings into a file in the present folder; a twin that diverges says
    # so itself.
    mujoco.set_mju_user_warning(logging.getLogger("mujoco").debug)
    command = None
    NOTES.begin()
    words = list(sys.argv[1:] if arguments is None else arguments)
    end_on_signals()
    try:
        command = parse(separate(words))
        command.check()
        check_writable(getattr(command, "json", None), getattr(command, "plot", None))
        status = int(command.run())
        _say_warnings()
        return status
    except WindupError as error:
        _say_warnings(error.kind if isinstance(error, UnwellError) else "")
        console.print(f"windup: {error}", markup=False, soft_wrap=True)
        if command is None:
            _write_unparsed(words, error)
        else:
            _write_error(command, error)
        return error.exit_status
    except KeyboardInterrupt:
        _say_warnings()
        console.print("windup: interrupted")
        return 130
    except BrokenPipeError:
        # Whoever read our words, such as `head`, has gone: what is left of them goes nowhere.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except SystemExit as parsed:
        status = parsed.code if isinstance(parsed.code, int) else 2
        if status != 0:
            said = f"the command line cannot be understood: {' '.join(words)}"
            _write_unparsed(words, UsageError(said))
        return status


def _say_warnings(ended_by: str = "") -> None:
    """Print what there was to warn about, but for the kind of what ended the run."""
    if said := NOTES.said(ended_by):
        console.print(f"warning: {said}", markup=False, soft_wrap=True)


def _write_unparsed(arguments: list[str], error: WindupError) -> None:
    """Tell programs that their command line could not be understood."""
    if "--json" in arguments[:-1]:
        target = Path(arguments[arguments.index("--json") + 1])
        with suppress(OSError):
            write_json(target, arguments[0], error_record(error))


def parse(arguments: list[str]) -> Any:
    """Return the command that the arguments mean; exits with status 2 if they mean none.

    Raises:
        UsageError: An option that takes numbers has another word.
    """
    said = io.StringIO()
    try:
        with redirect_stderr(said), redirect_stdout(said):
            return _parse(arguments)
    except SystemExit:
        if wrong := wrong_number(said.getvalue()):
            raise UsageError(wrong) from None
    return _parse(arguments)  # help, or an error: said again as the terminal shows it best


def _parse(arguments: list[str]) -> Any:
    return tyro.cli(
        Command,
        prog="windup",
        description="Controllers for small servo humanoids: on the robot, and on its twin.",
        args=arguments,
        config=(tyro.conf.OmitSubcommandPrefixes, tyro.conf.OmitArgPrefixes),
    )


def _write_error(command: object, error: WindupError) -> None:
    """Tell programs too, where they asked for JSON."""
    with suppress(OSError):  # the error may be about this very file
        target = getattr(command, "json", None)
        write_json(target, type(command).__name__.lower(), error_record(error))
