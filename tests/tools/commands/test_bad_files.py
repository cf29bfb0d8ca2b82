"""No number of a robot's files opens anything unless it is finite."""

import copy
import shutil
import tomllib
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
import tomli_w
from hypothesis import given
from hypothesis import strategies as st

from tests.tools.conftest import refusal
from windup.robots import load_robot

FILES = {
    "robot.toml": "stand {}",
    "gaits/walk.toml": "walk {}",
    "gaits/crouch.toml": "play {} crouch",
    "gaits/get_up_back.toml": "rise {}",
    "stepping.toml": "push {} --impulse 1",
    "footprints.toml": "step {} --foot left --to 0.05 0.12",
    "stride.toml": "stride {}",
}
Place = tuple[str | int, ...]


def numbers(data: Any, place: Place = ()) -> Iterator[Place]:
    """Yield where the numbers of a file stand."""
    if isinstance(data, dict | list):
        for key, item in data.items() if isinstance(data, dict) else enumerate(data):
            yield from numbers(item, (*place, key))
    elif isinstance(data, int | float) and not isinstance(data, bool):
        yield place


def changed(data: Any, place: Place, value: float) -> Any:
    """Return the file with another number there."""
    data = copy.deepcopy(data)
    *way, last = place
    inner = data
    for key in way:
        inner = inner[key]
    inner[last] = value
    return data


def written(place: Place) -> str:
    """Return a place as messages call it."""
    return "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in place)[1:]


pytestmark = pytest.mark.usefixtures("nothing_opens")
FOLDER = load_robot("op3").folder
DATA = {name: tomllib.loads((FOLDER / name).read_text()) for name in FILES}
PLACES = [(name, place) for name in FILES for place in numbers(DATA[name])]


@given(st.sampled_from(PLACES), st.sampled_from([float("nan"), float("inf"), float("-inf"), 1e300]))
def test_a_number_of_a_file_that_is_not_finite_is_named_and_opens_nothing(
    where: tuple[str, Place], value: float
) -> None:
    name, place = where
    with TemporaryDirectory() as folder:
        robot = Path(shutil.copytree(FOLDER, Path(folder) / "robot"))
        path = robot / name
        path.write_text(tomli_w.dumps(changed(DATA[name], place, value)))
        line = FILES[name].format(robot).split()
        said = refusal([*line, "--port", "/dev/ttyUSB9", "--arm"])
    assert said.startswith(f"windup: {path}: {written(place)}: ")
