"""One run of a sweep: runs a command in this process, and flattens its result into a row."""

import io
import json
import shlex
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass, fields, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, get_args, get_type_hints

import tyro

from windup.hal.errors import UnknownNameError, UsageError, WindupError
from windup.hal.ranges import check_numbers
from windup.tools.cli import parse
from windup.tools.command_line.parse_errors import gist
from windup.tools.sweeps.sweep_grid import Axis, Point
from windup.tools.sweeps.sweep_table import Row, typed
from windup.tools.terminal.output import to_json_types

OURS = ("seed", "seeds", "json", "plot")  # options that the sweep itself sets
YES, NO = ("true", "yes", "on", "1"), ("false", "no", "off", "0")
LEFT_OUT = ("schema", "command", "seed")


@dataclass(frozen=True)
class Run:
    """One run: a command line, the values of the swept options, and a seed."""

    command: str
    point: Point
    seed: int

    @property
    def key(self) -> dict[str, Any]:
        """Return the columns that identify the run of a row."""
        values = {name: typed(value) for name, value in self.point.items()}
        return {"command": self.command, **values, "seed": self.seed}


def check_line(line: list[str], axes: list[Axis]) -> None:
    """Check the command and the grid before anything runs.

    Raises:
        UsageError: The command cannot be swept, or its parser rejects a value.
        UnknownNameError: A name on the grid is not one of its options.
    """
    command = parse_quietly(line)
    check_numbers(command, "--")
    known = [field.name for field in fields(command)]
    if not set(OURS[:3]) <= set(known):
        raise UsageError(f"{line[0]} has no seeds and no --json; there is nothing to sweep")
    for name in OURS:
        if getattr(command, name, None) not in (None, 0):
            raise UsageError(f"--{name} cannot stand in a sweep's command; the sweep gives it")
    hints = get_type_hints(type(command), include_extras=True)
    if any("twin://" not in url for url in _ports(command, axes)):
        raise UsageError("a sweep runs many at once, on twins only; leave --port away")
    options = [name for name in known if name not in OURS and not _positional(hints[name])]
    for axis in axes:
        if axis.name not in options:
            raise UnknownNameError("--grid option", axis.name, options)
        for value in axis.checked:
            point = arguments(type(command), {axis.name: value})
            check_numbers(parse_quietly(line + point), "--")


def arguments(kind: type, point: Point) -> list[str]:
    """Return a point as arguments of a command of class `kind`.

    Raises:
        UsageError: The value of a switch is not true or false.
    """
    hints = get_type_hints(kind)
    words = []
    for name, value in point.items():
        option = name.replace("_", "-")
        if hints[name] is bool:
            if value.lower() not in YES + NO:
                raise UsageError(f"--grid {name}={value}: a switch is true or false")
            words.append(f"--{option}" if value.lower() in YES else f"--no-{option}")
        elif "tuple" in str(hints[name]):
            words += [f"--{option}", *value.split("+")]
        else:
            words += [f"--{option}", value]
    return words


def play(run: Run) -> Row:
    """Run a command and return its row; any failure is in the row's `error`."""
    row: Row = {**run.key, "exit_status": None, "error": None}
    try:
        line = shlex.split(run.command)
        kind = type(parse_quietly(line))
        command = parse_quietly(line + arguments(kind, run.point))
        with TemporaryDirectory(prefix="windup-") as folder:
            target = Path(folder) / "result.json"
            command = replace(command, seed=run.seed, json=target)
            command.check()
            row["exit_status"] = command.run()
            result = json.loads(target.read_text(encoding="utf-8"))
    except WindupError as error:
        row |= {"exit_status": error.exit_status, "error": str(error)}
        return row
    except Exception as error:  # the bug of one run must not end the whole sweep
        row |= {"exit_status": 1, "error": f"{type(error).__name__}: {error}"}
        return row
    for name, value in flat({k: v for k, v in result.items() if k not in LEFT_OUT}).items():
        row[name if name not in row else f"result.{name}"] = value
    return row


def flat(value: Any, name: str = "") -> Row:
    """Flatten nested results: names joined by dots, list items by name or index.

    >>> flat({"a": {"b": 1}, "rv": [{"name": "up", "mean": 0.2}], "path": [3, 4]})
    {'a.b': 1, 'rv.up.mean': 0.2, 'path.0': 3, 'path.1': 4}
    """
    if isinstance(value, dict):
        items = list(value.items())
    elif isinstance(value, list):
        items = [_item(index, item) for index, item in enumerate(value)]
    else:
        return {name: to_json_types(value)}
    row: Row = {}
    for key, item in items:
        row |= flat(item, f"{name}.{key}" if name else str(key))
    return row


def _item(index: int, item: Any) -> tuple[str, Any]:
    if isinstance(item, dict) and "name" in item:
        return str(item["name"]), {key: value for key, value in item.items() if key != "name"}
    return str(index), item


def parse_quietly(line: list[str]) -> Any:
    """Return the command of a command line, without printing anything.

    Raises:
        UsageError: The command line is invalid.
    """
    said = io.StringIO()
    try:
        with redirect_stderr(said), redirect_stdout(said):
            return parse(line)
    except SystemExit:
        raise UsageError(f"{' '.join(line) or 'sweep'}: {gist(said.getvalue())}") from None


def _ports(command: Any, axes: list[Axis]) -> list[str]:
    given = getattr(command, "port", None)
    swept = [value for axis in axes if axis.name == "port" for value in axis.values]
    return swept + ([] if given is None else [given])


def _positional(hint: Any) -> bool:
    return tyro.conf.Positional in get_args(hint)[1:]
