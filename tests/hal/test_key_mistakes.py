"""All mistakes in the keys of a file at once; without the unknown ones the rest is decoded."""

from typing import Annotated, Any

import msgspec
import pytest
from msgspec import Meta

from windup.hal.config import TomlRecord
from windup.hal.key_mistakes import key_mistakes, without_unknown


class Leg(TomlRecord, frozen=True):
    name: str
    length: Annotated[float, Meta(gt=0.0)] = 1.0
    lean: tuple[float, float] | None = None


class Robot(TomlRecord, frozen=True):
    title: str
    leg: tuple[Leg, ...] = ()
    pose: dict[str, float] | list[float] = {}
    spare: Leg | None = None


def said(data: Any) -> list[str]:
    return [f"{mistake.key}: {mistake.message}" for mistake in key_mistakes(data, Robot)]


def test_a_right_file_has_no_mistake() -> None:
    assert said({"title": "a", "leg": [{"name": "l", "lean": [0, 1]}], "pose": [1, 2.5]}) == []


def test_every_mistake_is_found_at_once() -> None:
    data = {
        "titel": "a",
        "leg": [{"name": "l"}, {"name": 3, "lenght": 2}, {"length": -1}],
        "pose": {"knee": "bent"},
        "spare": {"lean": [0]},
    }
    assert said(data) == [
        "titel: unknown key; did you mean 'title'? known: leg, pose, spare, title",
        "title: is missing",
        "leg[1].lenght: unknown key; did you mean 'length'? known: lean, length, name",
        "leg[1].name: Expected `str`, got `int`",
        "leg[2].name: is missing",
        "leg[2].length: Expected `float` > 0.0",
        "pose.knee: Expected `float`, got `str`",
        "spare.name: is missing",
        "spare.lean: Expected `array` of length 2, got 1",
    ]


@pytest.mark.parametrize("value", ["left", 3, [1]])
def test_what_is_no_table_is_called_so(value: object) -> None:
    (line,) = said({"title": "a", "spare": value})
    assert line.startswith("spare: Expected `object | null`, got ")


def test_without_unknown_keys_the_rest_is_understood() -> None:
    data = {"title": "a", "colour": 1, "leg": [{"name": "l", "lenght": 2}]}
    rest = without_unknown(data, list(key_mistakes(data, Robot)))
    assert msgspec.convert(rest, Robot) == Robot(title="a", leg=(Leg(name="l"),))
    assert "colour" in data, "what the file says is left alone"
