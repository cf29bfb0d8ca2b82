"""Finds all required keys that are missing in a file."""

from collections.abc import Iterator
from typing import Annotated, Any, get_args, get_origin

import msgspec


def missing_keys(data: Any, kind: Any, key: str = "") -> Iterator[str]:
    """Yield the keys that type `kind` requires and `data` lacks, such as `joint[3].lower`.

    Args:
        data: Parsed contents of a file: dicts, lists and values.
        kind: The type: a record, or a container or union of records.
        key: Key of `data` in the file; "" for the whole file.
    """
    origin, inner = get_origin(kind), get_args(kind)
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        if isinstance(data, dict):
            yield from _of_record(data, kind, key)
    elif origin in (list, tuple) and inner:
        if isinstance(data, list):
            for index, item in enumerate(data):
                yield from missing_keys(item, inner[0], f"{key}[{index}]")
    elif origin is dict:
        if isinstance(data, dict):
            for name, item in data.items():
                yield from missing_keys(item, inner[1], f"{key}.{name}")
    elif origin is not None:  # a union, or a type annotated with its range
        for part in inner[:1] if origin is Annotated else inner:
            yield from missing_keys(data, part, key)


def _of_record(data: dict[str, Any], kind: type[msgspec.Struct], key: str) -> Iterator[str]:
    for item in msgspec.structs.fields(kind):
        place = f"{key}.{item.encode_name}" if key else item.encode_name
        if item.encode_name in data:
            yield from missing_keys(data[item.encode_name], item.type, place)
        elif item.required:
            yield place
