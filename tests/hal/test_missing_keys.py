from typing import Annotated

import pytest
from msgspec import Meta

from windup.hal.config import TomlRecord
from windup.hal.key_mistakes import key_mistakes


class Wheel(TomlRecord, frozen=True):
    radius: Annotated[float, Meta(gt=0.0)]
    spokes: int = 8


class Cart(TomlRecord, frozen=True):
    name: str
    weight: float | None
    wheels: tuple[Wheel, ...]
    spare: Wheel | None = None
    named: dict[str, Wheel] = {}


WHEEL = {"radius": 0.5}
WHOLE = {"name": "cart", "weight": 3.0, "wheels": [WHEEL]}


@pytest.mark.parametrize(
    ("data", "missing"),
    [
        (WHOLE, []),
        ({}, ["name", "weight", "wheels"]),
        ({**WHOLE, "wheels": [{}, WHEEL, {"spokes": 3}]}, ["wheels[0].radius", "wheels[2].radius"]),
        ({**WHOLE, "spare": {}}, ["spare.radius"]),
        ({**WHOLE, "named": {"left": {}}}, ["named.left.radius"]),
        ({"name": "cart", "wheels": [{}]}, ["weight", "wheels[0].radius"]),
        ({**WHOLE, "wheels": "round", "named": 3}, []),
    ],
)
def test_every_missing_key_is_named_at_once(data: object, missing: list[str]) -> None:
    found = key_mistakes(data, Cart)
    assert [mistake.key for mistake in found if mistake.kind == "missing"] == missing
