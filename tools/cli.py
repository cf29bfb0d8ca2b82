"""The `windup` command: parse, run, and turn errors into one line and an exit status."""

import logging
import sys
from pathlib import Path
from typing import Any

from windup.hal.errors import MonitoredLimitError, UsageError, WindupError
from windup.tools.command_line.near_word import near_word
from windup.tools.command_line.overview import overview
from windup.tools.command_line.sweep_line import separate
from windup.tools.command_line.table import COMMANDS
from windup.tools.command_line.version import installed_version
from windup.tools.stopping.interrupts import end_on_signals, ignore_signals
from windup.tools.stopping.stop_runs import parse_stop
from windup.tools.terminal.result import print_result
from windup.tools.terminal.run_notes import NOTES
from windup.tools.terminal.say import say
from windup.tools.terminal.streams import drop_unwritten, fill_closed_streams
from windup.tools.terminal.writing import check_writable


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
    command = None
    NOTES.begin()
    words = list(sys.argv[1:] if arguments is None else arguments)
    end_on_signals()
    try:
        command = parse(words)
        _quiet_mujoco()
        command.check()
        check_writable(getattr(command, "json", None))
        command.warn()
        status = int(command.run())
        _say_warnings()
        return _say_lost(status)
    except WindupError as error:
        _say_warnings(error.kind if isinstance(error, MonitoredLimitError) else "")
        say(f"windup: {error}")
        if command is None:
            _write_unparsed(words, error)
        else:
            _write_error(command, error)
        return error.exit_status
    except KeyboardInterrupt:
        _say_warnings()
        say("windup: interrupted")
        return 130
    except BrokenPipeError:
        return 1  # whoever read our words, such as `head`, has gone
    except SystemExit as parsed:
        return parsed.code if isinstance(parsed.code, int) else 2


def _quiet_mujoco() -> None:
    """Keep MuJoCo from writing its warnings into a file in the present folder.

    A twin that diverges says so itself.
    """
    if (mujoco := sys.modules.get("mujoco")) is not None:
        mujoco.set_mju_user_warning(logging.getLogger("mujoco").debug)


def _say_warnings(ended_by: str = "") -> None:
    """Print what there was to warn about, but for the kind of what ended the run."""
    if said := NOTES.summary(ended_by):
        say(f"warning: {said}")


def _say_lost(status: int) -> int:
    """Print which results could not be written; return the exit status, 1 if it was 0."""
    for why in filter(None, NOTES.lost):
        say(f"windup: {why}")
    return status or int(bool(NOTES.lost))


def _write_unparsed(arguments: list[str], error: WindupError) -> None:
    """Tell programs that their command line could not be decode."""
    if "--json" in arguments[:-1]:
        _write_record(Path(arguments[arguments.index("--json") + 1]), arguments[0], error)


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
    if arguments == ["--version"]:
        print_result(f"windup {installed_version()}\n")
        raise SystemExit(0)
    if (name := arguments[0]) not in COMMANDS:
        near = near_word(name, (*COMMANDS, "--help"))
        raise UsageError(f"unknown command {name!r}{near}; `windup --help` lists all")
    if name == "stop" and (stop := parse_stop(arguments[1:])) is not None:
        return stop
    from windup.tools.command_line.parsing import (
        parse_options,  # only now: it takes longer than the help
    )

    words = separate(arguments)[1:]
    return parse_options(name, COMMANDS[name].load().specialised(words), words)


def _write_error(command: object, error: WindupError) -> None:
    """Tell programs too, where they asked for JSON."""
    target = getattr(command, "json", None)
    _write_record(target, type(command).__name__.lower(), error)


def _write_record(target: Path | None, command: str, error: WindupError) -> None:
    """Write an error as JSON."""
    from windup.tools.terminal.output import error_record, write_json

    write_json(target, command, error_record(error))
