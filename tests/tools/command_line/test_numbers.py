"""No number of the command line opens anything unless it is finite and in its range."""

from dataclasses import fields
from pathlib import Path
from typing import Any, get_args, get_type_hints

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.tools.conftest import refusal
from windup import Robot
from windup.hal.errors import UsageError
from windup.hal.ranges import Range
from windup.tools.command_line.table import COMMANDS

OWN = Path(__file__).parents[3] / "examples" / "shoulder_sine.py"
LINES = {
    "walk": "walk op3 --port /dev/ttyUSB9 --arm",
    "play": "play op3 wave --port /dev/ttyUSB9 --arm",
    "stand": "stand duck --port /dev/ttyUSB9 --arm",
    "rise": "rise op3 --port /dev/ttyUSB9 --arm",
    "push": "push op3 --impulse 1 --port /dev/ttyUSB9",
    "step": "step op3 --foot left --to 0.05 0.12 --port /dev/ttyUSB9",
    "footprints": "footprints op3 --random 2 --port /dev/ttyUSB9",
    "stride": "stride op3 --port /dev/ttyUSB9",
    "up": "up op3 --port /dev/ttyUSB9 --arm",
    "down": "down op3",
    "status": "status op3",
    "run": f"run op3 {OWN} --port /dev/ttyUSB9",
    "stop": "stop op3 --port /dev/ttyUSB9",
    "scan": "scan /dev/ttyUSB9",
    "emulate": "emulate op3",
    "health": "health op3",
    "robots": "robots",
    "check": "check op3",
    "new": "new robot rex",
    "estimate": "estimate op3 --port twin://op3",
    "bench": "bench tick",
    "sweep": "sweep walk op3 --out sweep.csv",
    "reproduce": "reproduce laszlo --quick",
    "synthesise": "synthesise op3 --out gait.toml",
}
BAD = ("nan", "inf", "-inf", "-1", "1e308", "1e999", str(10**12), "-" + "9" * 400)


def numeric(hint: Any) -> bool:
    """Return whether a type has a number in it."""
    inner = get_args(hint)
    return hint in (int, float) or any(numeric(part) for part in inner)


def ranges(hint: Any) -> list[Range]:
    """Return the ranges that stand in a type."""
    parts = (*getattr(hint, "__metadata__", ()), *get_args(hint))
    return [r for part in parts for r in ([part] if isinstance(part, Range) else ranges(part))]


OPTIONS: dict[tuple[str, str], Any] = {
    (name, option.name): hint
    for name, entry in COMMANDS.items()
    for kind in [entry.load()]
    for hints in [get_type_hints(kind, include_extras=True)]
    for option in fields(kind)
    if numeric(hint := hints[option.name])
}


pytestmark = pytest.mark.usefixtures("nothing_opens")


def test_the_options_of_every_command_are_looked_at() -> None:
    assert set(LINES) == set(COMMANDS)
    assert len(OPTIONS) > 100


@pytest.mark.parametrize(("command", "option"), OPTIONS)
def test_every_number_of_a_command_says_its_range(command: str, option: str) -> None:
    (range, *_) = ranges(OPTIONS[command, option])
    assert -1e10 < range.low < range.high < 1e10


@given(st.sampled_from(sorted(OPTIONS)), st.sampled_from(BAD), st.integers(0, 1))
def test_a_bad_number_is_one_line_and_opens_nothing(
    place: tuple[str, str], bad: str, at: int
) -> None:
    command, option = place
    hint = OPTIONS[place]
    name = "--" + option.replace("_", "-")
    pair = "tuple" in str(hint)
    values = ["0.1", "0.1"] if pair else [bad]
    values[at if pair else 0] = bad
    assume(ranges(hint)[0].problem(float(bad)))
    words = [name, *values] if pair else [f"{name}={bad}"]
    assert refusal([*LINES[command].split(), *words]).startswith(f"windup: {name} ")


TEXTS = {
    "style": ("walk op3 --style stride=nan", "--style stride=nan: nan: give a finite number"),
    "begin": ("walk op3 --style stride=1@nan:3", "nan: give a finite number"),
    "blend": ("walk human --blend run=inf", "--blend run=inf: inf: give a finite number"),
    "target": ("walk op3 --target up=nan", "--target up=nan: nan: give a finite number"),
    "circle": ("walk op3 --path circle:nan", "--path circle:nan: nan: give a finite number of m"),
    "device": ("walk op3 --path /dev/zero", "--path /dev/zero: this is a device, not a file"),
    "gait": ("walk op3 --gait /dev/zero", "unknown gait of op3 '/dev/zero'"),
    "footprints": ("footprints op3 /dev/zero", "/dev/zero: cannot be read: this is a device"),
    "then": ("stride op3 --then nan,0.1", "--then nan,0.1: nan: give a finite number"),
    "forbid": ("push op3 --impulse 1 --forbid 0,inf,1", "inf: give a finite number of m"),
    "grid": ("sweep walk op3 --grid speed=nan --out a.csv", "--speed nan: give a finite number"),
    "range": ("sweep walk op3 --grid speed=0:inf:3 --out a.csv", "inf: give a finite number"),
    "count": ("sweep walk op3 --grid speed=0:1:1000000000 --out a.csv", "give 2 .. 10000"),
    "runs": ("sweep walk op3 --grid speed=0:1:9999 --seeds 9999 --out a.csv", "a grid of 9998"),
    "weight": ("synthesise op3 --objective falls=inf --out a.toml", "give a finite number"),
    "baud": ("scan /dev/ttyUSB9 --baud 5", "--baud 5: give one of 9600, "),
    "socket": ("scan socket://here:99999999", "socket://here:99999999: Port out of range"),
    "word": ("walk op3 --steps many", "--steps many: give a whole number"),
    "one of two": ("walk op3 --to 1", "--to 1: give two numbers"),
    "seed": ("emulate op3 --seed 1.5", "--seed 1.5: give a whole number"),
}
URLS = {
    "supply=nan": "supply nan: give a finite number of V",
    "latency=nan": "latency nan: give a finite number of ms",
    "turnaround=-1": "turnaround -1: give 0 .. 1000000 us",
    "return_delay=999": "return_delay 999: give -1 .. 254",
    "baud=99999999": "baud 99999999: give 0 .. 10000000",
    "seed=-1": "seed -1: give 0 .. 4294967295",
    "servos=XM430-W350:1-1000000000": "ids are 0 .. 253",
    "servos=XM430-W350:9-1": "a model and its ids",
    "faults=drop:rate=nan": "drop: rate nan: give a finite number",
    "faults=late:seconds=nan": "late: seconds nan: give a finite number of s",
    "faults=reset:at=nan": "reset: at nan: give a finite number of s",
    "faults=dead:ids=1-1000000000": "ids up to 253",
    "faults=brown_out:volts=inf": "brown_out: volts inf: give a finite number of V",
}
PORTS = ("walk op3 --port twin://op3?{}", "stop op3 --port twin://op3?{}", "scan twin://bench?{}")


@pytest.mark.parametrize(("line", "said"), TEXTS.values(), ids=TEXTS)
def test_a_bad_number_in_a_text_is_one_line_and_opens_nothing(line: str, said: str) -> None:
    assert said in refusal(line.split())


@pytest.mark.parametrize("line", [*PORTS, "emulate twin://bench?{}"])
@pytest.mark.parametrize(("key", "said"), URLS.items(), ids=URLS)
def test_a_bad_number_in_an_address_is_one_line_and_opens_nothing(
    line: str, key: str, said: str
) -> None:
    assert said in refusal(line.format(key).split())


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "0 points; give 2 .. 10000 lines of x,y"),
        ("0,0\n1,nan\n", "line 2: nan: give a finite number of m"),
        ("0,0\n1,1e9\n", "line 2: 1e9: give -10000 .. 10000 m"),
        ("0,0\n" + "1" * 10**6, "field larger than field limit"),
        ("0,0\n1\n", "line 2 is not x,y"),
        ("0,0\n" * 10_001, "10001 points; give 2 .. 10000"),
        ("0,0\n" * 2**21, "longer than 4 MB"),
    ],
    ids=["empty", "nan", "far", "huge line", "one number", "many", "long"],
)
def test_a_bad_path_file_is_one_line_and_opens_nothing(text: str, said: str) -> None:
    Path("path.csv").write_text(text)
    assert said in refusal(["walk", "op3", "--path", "path.csv", "--port", "/dev/ttyUSB9"])


@pytest.mark.parametrize(
    "options",
    [{"delay": float("nan")}, {"rate": float("inf")}, {"noise": -1.0}, {"seed": -1}],
    ids=lambda options: next(iter(options)),
)
def test_robot_open_refuses_bad_numbers(options: dict[str, Any]) -> None:
    with pytest.raises(UsageError, match=f"{next(iter(options))} .*: give "):
        Robot.open("op3", port="/dev/ttyUSB9", **options)
