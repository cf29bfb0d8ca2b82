"""The `windup` command: parse, run, and turn errors into one line and an exit status."""

import logging
import sys
from typing import Annotated

import tyro

from hal.errors import WindupError
from tools.bench import Bench
from tools.estimate import Estimate
from tools.output import console, error_record, write_json
from tools.play import Play
from tools.robots_list import Robots
from tools.walk import Walk

Command = (
    Annotated[Walk, tyro.conf.subcommand("walk")]
    | Annotated[Play, tyro.conf.subcommand("play")]
    | Annotated[Robots, tyro.conf.subcommand("robots")]
    | Annotated[Estimate, tyro.conf.subcommand("estimate")]
    | Annotated[Bench, tyro.conf.subcommand("bench")]
)


def main(arguments: list[str] | None = None) -> None:
    """Run the command line; does not return."""
    sys.exit(run(arguments))


def run(arguments: list[str] | None = None) -> int:
    """Run the command line and return the exit status."""
    logging.basicConfig(level=logging.WARNING)
    command = None
    try:
        command = tyro.cli(
            Command,
            prog="windup",
            description="Controllers for small servo humanoids: on the robot, and on its twin.",
            args=arguments,
            config=(tyro.conf.OmitSubcommandPrefixes, tyro.conf.OmitArgPrefixes),
        )
        return int(command.run())
    except WindupError as error:
        console.print(f"windup: {error}", markup=False, soft_wrap=True)
        _write_error(command, error)
        return error.exit_status
    except KeyboardInterrupt:
        console.print("windup: interrupted")
        return 130


def _write_error(command: object, error: WindupError) -> None:
    """Tell programs too, where they asked for JSON."""
    name = type(command).__name__.lower()
    write_json(getattr(command, "json", None), name, error_record(error))
