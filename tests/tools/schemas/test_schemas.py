"""The stored schemas are those of the records, and judge files as the records do."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from windup.control.footprints.directed_file import Directed
from windup.robots import load_robot, robot_names
from windup.robots.records import JointEntry, RobotFile
from windup.tools.schemas.docstrings import key_texts, record_text
from windup.tools.schemas.files import RECORDS, schema_line, schema_path
from windup.tools.schemas.generate import schema_text, write_schemas

ROOT = Path(__file__).parents[3]


def files_of_the_package() -> Iterator[tuple[str, Path]]:
    """Yield every TOML file of the robots and pages, with the name of its schema."""
    for robot in map(load_robot, robot_names()):
        folder = robot.folder
        kind = robot.drive.kind
        beside = {name: name for name in ("stepping", "stride", "whole_body")}
        beside["footprints"] = f"footprint_gains_{kind}"
        yield "robot", folder / "robot.toml"
        yield from (("gait", path) for path in robot.gaits().values())
        for stem, name in beside.items():
            if (path := folder / f"{stem}.toml").exists():
                yield name, path
    yield from (("footprint_list", path) for path in (ROOT / "docs").glob("*.toml"))


FILES = [pytest.param(name, path, id=f"{path.parts[-2]}/{path.name}") for name, path in
         files_of_the_package()]  # fmt: skip


def judge(name: str) -> Any:
    return jsonschema.Draft7Validator(json.loads(schema_path(name).read_text(encoding="utf-8")))


@pytest.mark.parametrize("name", RECORDS)
def test_the_stored_schema_is_current(name: str) -> None:
    stored = schema_path(name).read_text(encoding="utf-8")
    assert stored == schema_text(RECORDS[name]), "run `make schemas`"


def test_all_schemas_are_written_to_where_they_are_read(tmp_path: Path) -> None:
    assert [path.name for path in write_schemas(tmp_path)] == [
        schema_path(name).name for name in RECORDS
    ]


@pytest.mark.parametrize("name", RECORDS)
def test_a_schema_is_one_of_draft_7(name: str) -> None:
    jsonschema.Draft7Validator.check_schema(json.loads(schema_text(RECORDS[name])))


@pytest.mark.parametrize(("name", "path"), FILES)
def test_every_file_of_the_package_fits(name: str, path: Path) -> None:
    data = tomllib.loads(path.read_text(encoding="utf-8"))
    assert [error.message for error in judge(name).iter_errors(data)] == []


@pytest.mark.parametrize(("name", "path"), FILES)
def test_an_unknown_key_and_a_missing_one_do_not_fit(name: str, path: Path) -> None:
    data = tomllib.loads(path.read_text(encoding="utf-8"))
    (needed,) = judge(name).schema["required"][:1]
    del data[needed]
    said = sorted(error.validator for error in judge(name).iter_errors(data | {"colour": 1}))
    assert said == ["additionalProperties", "required"]


def test_numbers_have_their_ranges_and_pairs_their_length() -> None:
    state = {"name": "a", "until": {"time": -1.0}, "reach": {"lean": [1.0, 2.0, 3.0]}}
    errors = judge("gait").iter_errors({"title": "a", "state": [state]})
    assert {"maxItems", "minimum"} <= {error.validator for error in errors}


def test_keys_have_what_the_docstrings_say_of_them() -> None:
    schema = json.loads(schema_path("robot").read_text(encoding="utf-8"))
    assert schema["properties"]["rate_hz"]["description"] == key_texts(RobotFile)["rate_hz"]
    joint = schema["definitions"]["JointEntry"]["properties"]
    assert joint["zero"]["description"] == key_texts(JointEntry)["zero"]
    gains = json.loads(schema_path("footprint_gains_servo").read_text(encoding="utf-8"))
    assert gains["properties"]["swing"]["description"] == key_texts(Directed)["swing"]


def test_a_docstring_is_split_into_the_record_and_its_keys() -> None:
    class Thing:
        """A thing.

        It is
        small.

        Attributes:
            mass: How heavy it is,
                kg.
            size: How large, m.

        Raises:
            nothing: Ever.
        """

    assert record_text(Thing) == "A thing.\nIt is small."
    assert key_texts(Thing) == {"mass": "How heavy it is, kg.", "size": "How large, m."}


def test_the_line_for_editors_names_a_file_that_is_there() -> None:
    word, url = schema_line("robot").split()
    assert word == "#:schema"
    assert Path(url.removeprefix("file://")).is_file()
