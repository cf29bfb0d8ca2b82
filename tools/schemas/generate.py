"""Generates the JSON Schemas of all files: `make schemas`.

They are of draft 7, which the TOML plug-ins of editors support.
"""

import json
from math import isfinite
from pathlib import Path
from typing import Any, Final

import msgspec

from windup.tools.schemas.docstrings import key_texts, record_text
from windup.tools.schemas.files import FOLDER, RECORDS, SUFFIX

DRAFT: Final = "http://json-schema.org/draft-07/schema#"
NULL: Final = {"type": "null"}


def write_schemas(folder: Path = FOLDER) -> list[Path]:
    """Write the schema of each file into `folder`; return their paths."""
    paths = []
    for name, record in RECORDS.items():
        path = folder / f"{name}{SUFFIX}"
        path.write_text(schema_text(record), encoding="utf-8")
        paths.append(path)
    return paths


def schema_text(record: type[Any]) -> str:
    """Return the schema of the files of a record as JSON."""
    return json.dumps(schema_of(record), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def schema_of(record: type[Any]) -> dict[str, Any]:
    """Return the schema of the files of a record."""
    template = "#/definitions/{name}"
    (root,), parts = msgspec.json.schema_components([record], ref_template=template)
    classes = {kind.__name__: kind for kind in _records(record)}
    for part in parts.values():
        if part.get("type") == "object" and part.get("title") in classes:
            _describe(part, classes[part["title"]])
    parts = _of_draft_7(parts)
    whole = parts.pop(root["$ref"].rpartition("/")[2])
    return {"$schema": DRAFT, **whole, "definitions": parts}


def _describe(part: dict[str, Any], record: type[Any]) -> None:
    """Add descriptions from the docstring to the schema of a record and to those of its keys."""
    part["description"] = record_text(record)
    texts = key_texts(record)
    for name, schema in part.get("properties", {}).items():
        if name in texts:
            schema["description"] = texts[name]


def _of_draft_7(schema: Any) -> Any:
    """Return a schema converted to draft 7, without null, nan and inf, which no file may have."""
    if isinstance(schema, list):
        return [_of_draft_7(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    schema = {key: value for key, value in schema.items() if not _without_value(key, value)}
    choices = [item for item in schema.pop("anyOf", []) if item != NULL]
    if len(choices) == 1:
        schema = {**choices[0], **schema}
    elif choices:
        schema["anyOf"] = choices
    if "prefixItems" in schema:  # a tuple of fixed length, in later drafts
        schema["items"] = schema.pop("prefixItems")
        schema["additionalItems"] = False
    return {key: _of_draft_7(value) for key, value in schema.items()}


def _without_value(key: str, value: Any) -> bool:
    """Return whether `value` is a default that no file may have."""
    infinite = isinstance(value, float) and not isfinite(value)
    return key == "default" and (value is None or infinite)


def _records(kind: Any, seen: set[Any] | None = None) -> set[type[Any]]:
    """Return a record, and all records inside it."""
    seen = set() if seen is None else seen
    for inner in getattr(kind, "__args__", ()):
        _records(inner, seen)
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct) and kind not in seen:
        seen.add(kind)
        for item in msgspec.structs.fields(kind):
            _records(item.type, seen)
    return seen


if __name__ == "__main__":
    write_schemas()
