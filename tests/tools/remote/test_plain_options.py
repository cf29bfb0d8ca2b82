from dataclasses import dataclass
from pathlib import Path

import pytest

from windup.hal.errors import UsageError
from windup.tools.remote.plain_options import check_alone, options_as_data, options_of
from windup.tools.terminal.quantities import Seconds


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of a behaviour."""

    graph: str
    seconds: Seconds = 1.0
    names: tuple[str, ...] = ()
    to: tuple[float, float] | None = None
    file: Path | None = None


@dataclass(frozen=True, kw_only=True)
class Command(Options):
    """The same with an option of a robot that is opened."""

    noise: float = 0.0
    up: bool = True


FULL = Options(graph="wave", seconds=2.0, names=("a", "b"), to=(0.5, 1.0), file=Path("/a/b"))


@pytest.mark.parametrize("options", [Options(graph="wave"), FULL], ids=["few", "all"])
def test_options_come_back_as_they_were(options: Options) -> None:
    assert options_of(Options, options_as_data(options)) == options


def test_only_what_is_given_is_sent() -> None:
    assert options_as_data(Options(graph="wave", seconds=2.0)) == {"graph": "wave", "seconds": 2.0}


def test_a_path_is_meant_in_the_folder_of_the_client() -> None:
    sent = options_as_data(Options(graph="wave", file=Path("walk.csv")))
    assert sent["file"] == str(Path.cwd() / "walk.csv")


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"graph": "wave", "speeed": 1.0}, "unknown option 'speeed'; known: file, graph"),
        ({}, "missing required field `graph`"),
        ({"graph": 3}, "Expected `str`, got `int`"),
        ({"graph": "wave", "seconds": -1.0}, "seconds"),
        ({"graph": "wave", "seconds": float("nan")}, "seconds"),
    ],
)
def test_options_that_cannot_be_are_refused(given: dict[str, object], why: str) -> None:
    with pytest.raises(UsageError, match=why):
        options_of(Options, given)


def test_an_option_of_a_robot_that_is_opened_is_refused_on_one_that_is_up() -> None:
    check_alone(Command(graph="wave", seconds=3.0), Options)
    with pytest.raises(UsageError, match="--noise is of a robot that this command opens"):
        check_alone(Command(graph="wave", noise=1.0), Options)
