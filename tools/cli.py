"""The `windup` command: parse, run, and turn errors into one line and an exit status."""

import io
import logging
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Annotated, Any, get_args

import mujoco
import tyro

from hal.errors import UnwellError, UsageError, WindupError
from tools.bench import Bench
from tools.emulate import Emulate
from tools.estimate import Estimate
from tools.footprints import Footprints
from tools.health import Health
from tools.interrupts import end_on_signals, ignore_signals
from tools.output import console, error_record, print_result, write_json
from tools.overview import overview
from tools.parse_errors import mistake
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
from tools.streams import drop_unwritten, fill_closed_streams
from tools.stride import Stride
from tools.sweep import Sweep, separate
from tools.synthesis import Synthesise
from tools.walk import Walk
from tools.writing import STANDARD_OUTPUT, check_writable, writing

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

COMMANDS: dict[str, type] = {
    get_args(command)[1].name: get_args(command)[0] for command in get_args(Command)
}


def main(arguments: list[str] | None = None) -> None:
    """Run the command line; does not return."""
    fill_closed_streams()
    status = run(arguments)
    ignore_signals()
    drop_unwritten(sys.stdout)
    drop_unwritten(sys.stderr)
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
        check_writable(getattr(command, "json", None))
        command.warn()
        status = int(command.run())
        _say_warnings()
        return _say_lost(status)
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
        return 1  # whoever read our words, such as `head`, has gone
    except SystemExit as parsed:
        return parsed.code if isinstance(parsed.code, int) else 2


def _say_warnings(ended_by: str = "") -> None:
    """Print what there was to warn about, but for the kind of what ended the run."""
    if said := NOTES.said(ended_by):
        console.print(f"warning: {said}", markup=False, soft_wrap=True)


def _say_lost(status: int) -> int:
    """Print which results could not be written; return the exit status, 1 if it was 0."""
    for why in filter(None, NOTES.lost):
        console.print(f"windup: {why}", markup=False, soft_wrap=True)
    return status or int(bool(NOTES.lost))


def _write_unparsed(arguments: list[str], error: WindupError) -> None:
    """Tell programs that their command line could not be understood."""
    if "--json" in arguments[:-1]:
        target = Path(arguments[arguments.index("--json") + 1])
        write_json(target, arguments[0], error_record(error))


def parse(arguments: list[str]) -> Any:
    """Return the command that the arguments mean; exits with status 0 behind a help text.

    Raises:
        UsageError: They mean none, or ask for help where standard output is closed.
        OutputError: The help cannot be written.
    """
    if not arguments:
        raise UsageError("give a command, such as `windup robots`; `windup --help` lists all")
    if arguments in (["-h"], ["--help"]):
        print_result(overview(COMMANDS))
        raise SystemExit(0)
    said = io.StringIO()
    try:
        with redirect_stderr(said), redirect_stdout(said):
            return _parse(arguments)
    except SystemExit as ended:
        if ended.code:
            raise UsageError(mistake(arguments, COMMANDS, said.getvalue())) from None
    check_writable(STANDARD_OUTPUT)
    with writing(STANDARD_OUTPUT):
        try:
            return _parse(arguments)  # its help: again, as wide as the terminal is
        finally:
            sys.stdout.flush()


def _parse(arguments: list[str]) -> Any:
    return tyro.cli(
        Command,
        prog="windup",
        args=arguments,
        config=(tyro.conf.OmitSubcommandPrefixes, tyro.conf.OmitArgPrefixes),
    )


def _write_error(command: object, error: WindupError) -> None:
    """Tell programs too, where they asked for JSON."""
    target = getattr(command, "json", None)
    write_json(target, type(command).__name__.lower(), error_record(error))
