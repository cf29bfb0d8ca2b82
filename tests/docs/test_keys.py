"""The tables of keys of the documentation are those of the records."""

import dataclasses
import re
from importlib import import_module
from typing import Any

import msgspec
import pytest

from tests.docs.pages import PAGES, read
from windup.control.pose_graph.gait_file import GaitFile
from windup.hal.config import TomlRecord
from windup.robots.levels import Level
from windup.robots.records import RobotFile, StiffnessShares

TABLE = re.compile(r"<!-- keys: ([\w.]+)\.(\w+) -->\n\n((?:\|.*\n)+)")
ROW = re.compile(r"^\| `(\w+)` \| (.*?) \|", flags=re.MULTILINE)
FIELDS = re.compile(r"<!-- fields: ([\w.]+)\.(\w+) -->\n\n\|.*\n\|.*\n((?:\|.*\n)+)")
IN_A_ROW = {StiffnessShares, Level}
"""Records that are so small that the row of their key explains them."""
FOUND = {
    f"{module}.{name}": rows for page in PAGES for module, name, rows in TABLE.findall(read(page))
}

FIELDS_OF = {
    f"{module}.{name}": rows for page in PAGES for module, name, rows in FIELDS.findall(read(page))
}


def record(path: str) -> Any:
    module, _, name = path.rpartition(".")
    return getattr(import_module(module), name)


def defaults(kind: Any) -> dict[str, Any]:
    """Return key to default; None where the key has to be there, or nothing stands for it."""
    if dataclasses.is_dataclass(kind):
        fields = dataclasses.fields(kind)
        return {field.name: field.default for field in fields if field.name != "robot"}
    keys = msgspec.structs.fields(kind)
    return {key.encode_name: None if key.required else default(key) for key in keys}


def default(field: msgspec.structs.FieldInfo) -> Any:
    """Return the default of a key that may be left out."""
    made = field.default_factory
    return field.default if made is msgspec.NODEFAULT else made()


@pytest.mark.parametrize("path", FOUND)
def test_a_table_has_every_key_and_no_other(path: str) -> None:
    keys = [key for key, _ in ROW.findall(FOUND[path])]
    assert sorted(keys) == sorted(defaults(record(path)))


@pytest.mark.parametrize("path", FOUND)
def test_a_default_that_is_a_number_is_the_record_s(path: str) -> None:
    known = defaults(record(path))
    for key, said in ROW.findall(FOUND[path]):
        if re.fullmatch(r"-?\d+(\.\d+)?", said):
            assert float(said) == known[key], key
        elif not said:
            assert known[key] is None, f"{key} has a default"


@pytest.mark.parametrize("path", FIELDS_OF)
def test_a_table_of_fields_has_each_once_and_no_other(path: str) -> None:
    named = re.findall(r"`(\w+)`", " ".join(row.split("|")[1] for row in _rows(path)))
    assert sorted(named) == sorted(field.name for field in dataclasses.fields(record(path)))


def test_the_fields_of_a_servo_family_have_a_table() -> None:
    assert "windup.hal.families.family.Family" in FIELDS_OF


def _rows(path: str) -> list[str]:
    return FIELDS_OF[path].splitlines()


def nested(kind: Any, seen: set[Any]) -> set[Any]:
    """Return a record and all records inside it."""
    for inner in getattr(kind, "__args__", ()):
        nested(inner, seen)
    if isinstance(kind, type) and issubclass(kind, TomlRecord) and kind not in seen:
        seen.add(kind)
        for field in msgspec.structs.fields(kind):
            nested(field.type, seen)
    return seen


@pytest.mark.parametrize("file", [RobotFile, GaitFile])
def test_every_record_of_a_file_has_a_table(file: Any) -> None:
    wanted = {kind.__name__ for kind in nested(file, set()) - IN_A_ROW}
    assert wanted <= {path.rpartition(".")[2] for path in FOUND}
